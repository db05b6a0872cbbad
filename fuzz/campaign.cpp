#include "campaign.hpp"

#include <poll.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "draw_seeded.hpp"
#include "support/random_scenes.hpp"

namespace hybrid_sphere::fuzz {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto too_long = "a run stays under its limit of processor time";
constexpr auto crashes = "no run ends the process";

/// SIGPROF, which ends the process, comes after so much processor time; 0: never.
void limit_cpu(double seconds) {
  const auto whole = static_cast<time_t>(seconds);
  const auto micro = static_cast<suseconds_t>((seconds - static_cast<double>(whole)) * 1e6);
  const itimerval timer{{0, 0}, {whole, micro}};
  setitimer(ITIMER_PROF, &timer, nullptr);
}

Verdict verdict_of_end(int status) {
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGPROF) return {Verdict::Kind::found, too_long, ""};
  return {Verdict::Kind::found, crashes, "status " + std::to_string(status)};
}

std::string on_one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
  return text.substr(0, 1000);
}

std::string line_of(std::uint64_t number, const Verdict& verdict) {
  return std::to_string(number) + '\t' + static_cast<char>(verdict.kind) + '\t' + on_one_line(verdict.claim) +
         '\t' + on_one_line(verdict.words) + '\n';
}

void write_all(int file, const std::string& text) {
  std::size_t done = 0;
  while (done < text.size()) {
    const ssize_t written = write(file, text.data() + done, text.size() - done);
    if (written <= 0) _exit(1);
    done += static_cast<std::size_t>(written);
  }
}

/// A line of a worker, taken apart.
struct Report {
  std::uint64_t number = 0;
  Verdict verdict;
};

Report parse(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == '\t') {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  if (fields.size() != 4 || fields[1].size() != 1) throw std::runtime_error("a worker sent: " + line);
  return {std::stoull(fields[0]), {static_cast<Verdict::Kind>(fields[1][0]), fields[2], fields[3]}};
}

/// A process that judges every n-th scene, and what it has told.
class Worker {
 public:
  Worker(const Campaign& campaign, std::uint64_t next, Clock::time_point deadline)
      : campaign_(campaign), next_(next), deadline_(deadline) {
    start();
  }

  int file() const { return file_; }
  bool done() const { return file_ < 0; }

  /// Takes what there is to read; a worker that died says so, and another one goes on after its scene.
  template <class Take>
  void read_some(const Take& take) {
    char block[65536];
    const ssize_t count = read(file_, block, sizeof block);
    if (count > 0) {
      text_.append(block, static_cast<std::size_t>(count));
      for (std::size_t end = text_.find('\n'); end != std::string::npos; end = text_.find('\n')) {
        const Report report = parse(text_.substr(0, end));
        text_.erase(0, end + 1);
        next_ = report.number + static_cast<std::uint64_t>(campaign_.processes);
        take(report);
      }
      return;
    }
    close(file_);
    file_ = -1;
    int status = 0;
    waitpid(process_, &status, 0);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    take({next_, verdict_of_end(status)});
    next_ += static_cast<std::uint64_t>(campaign_.processes);
    start();
  }

 private:
  void start() {
    text_.clear();
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    process_ = fork();
    if (process_ < 0) throw std::runtime_error("no process");
    if (process_ == 0) {
      close(ends[0]);
      work(ends[1]);
    }
    close(ends[1]);
    file_ = ends[0];
  }

  [[noreturn]] void work(int file) const {
    const std::uint64_t end = campaign_.first + campaign_.scenes;
    for (std::uint64_t i = next_; i < end && Clock::now() < deadline_;
         i += static_cast<std::uint64_t>(campaign_.processes)) {
      const Case a_case = case_of(campaign_, i);
      limit_cpu(campaign_.cpu_limit);
      const Verdict verdict = campaign_.judge(a_case);
      limit_cpu(0);
      write_all(file, line_of(i, verdict));
    }
    _exit(0);
  }

  const Campaign& campaign_;
  std::uint64_t next_;
  Clock::time_point deadline_;
  pid_t process_ = -1;
  int file_ = -1;
  std::string text_;
};

void show(const Campaign& campaign, const Report& report, int count, std::ostream& out) {
  const std::string& claim = report.verdict.claim;
  std::string character;
  Case a_case = case_of(campaign, report.number, &character);
  out << "finding: " << claim << "\n  seed " << campaign.seed << ", scene " << report.number << " ("
      << character << "): " << report.verdict.words << std::endl;
  if (count > 3) return;
  Verdict verdict = report.verdict;
  if (campaign.shrink) {
    a_case = shrink(campaign, a_case, claim);
    const Verdict last = judge_apart(campaign, a_case);
    if (last.kind == Verdict::Kind::found) verdict = last;
  }
  out << "# " << verdict.claim << ": " << verdict.words << "\n" << text_of(a_case) << std::endl;
  if (campaign.directory.empty()) return;
  std::filesystem::create_directories(campaign.directory);
  std::ofstream file(campaign.directory + "/" + character + "_" + std::to_string(campaign.seed) + "_" +
                     std::to_string(report.number) + ".yaml");
  file << "# " << verdict.claim << "\n# " << verdict.words << "\n" << text_of(a_case);
}

}  // namespace

Case case_of(const Campaign& campaign, std::uint64_t number, std::string* character) {
  begin_draws(campaign.seed, number);
  const auto kind =
      static_cast<std::size_t>(testing::integer(0, static_cast<int>(campaign.characters.size()) - 1));
  if (character != nullptr) *character = campaign.characters[kind].name;
  Case a_case = make_case(campaign.characters[kind]);
  if (campaign.hostile) make_hostile(a_case);
  return a_case;
}

Verdict judge_apart(const Campaign& campaign, const Case& a_case) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe");
  const pid_t process = fork();
  if (process < 0) throw std::runtime_error("no process");
  if (process == 0) {
    close(ends[0]);
    limit_cpu(campaign.cpu_limit);
    write_all(ends[1], line_of(0, campaign.judge(a_case)));
    _exit(0);
  }
  close(ends[1]);
  std::string text;
  char block[4096];
  for (ssize_t count = 0; (count = read(ends[0], block, sizeof block)) > 0;)
    text.append(block, static_cast<std::size_t>(count));
  close(ends[0]);
  int status = 0;
  waitpid(process, &status, 0);
  if (text.empty() || text.back() != '\n') return verdict_of_end(status);
  return parse(text.substr(0, text.size() - 1)).verdict;
}

Tally run(const Campaign& campaign, std::ostream& out) {
  const Clock::time_point begin = Clock::now();
  const auto deadline = campaign.seconds > 0 ? begin + std::chrono::duration_cast<Clock::duration>(
                                                           std::chrono::duration<double>(campaign.seconds))
                                             : Clock::time_point::max();
  std::vector<Worker> workers;
  for (int i = 0; i < campaign.processes; ++i)
    workers.emplace_back(campaign, campaign.first + static_cast<std::uint64_t>(i), deadline);
  Tally tally;
  const auto take = [&](const Report& report) {
    ++tally.scenes;
    ++tally.kinds[static_cast<char>(report.verdict.kind)];
    if (report.verdict.kind == Verdict::Kind::halted) ++tally.reasons[report.verdict.claim];
    if (report.verdict.kind == Verdict::Kind::refused) ++tally.refusals[report.verdict.claim];
    if (report.verdict.kind == Verdict::Kind::skipped) ++tally.skips[report.verdict.claim];
    if (report.verdict.kind != Verdict::Kind::found) return;
    const std::uint64_t count = ++tally.findings[report.verdict.claim];
    if (count <= 20) show(campaign, report, static_cast<int>(count), out);
  };
  for (;;) {
    std::vector<pollfd> files;
    std::vector<Worker*> readers;
    for (Worker& worker : workers) {
      if (worker.done()) continue;
      files.push_back({worker.file(), POLLIN, 0});
      readers.push_back(&worker);
    }
    if (files.empty()) break;
    if (poll(files.data(), files.size(), -1) < 0) continue;
    for (std::size_t i = 0; i < files.size(); ++i) {
      if (files[i].revents != 0) readers[i]->read_some(take);
    }
  }
  tally.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return tally;
}

}  // namespace hybrid_sphere::fuzz
