// Campaigns of generated scenes; --help says which.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iostream>
#include <sstream>

#include "campaign.hpp"
#include "hybrid_sphere/scene/read_scene.hpp"
#include "judges.hpp"
#include "scene/yaml.hpp"

namespace hybrid_sphere::fuzz {
namespace {

struct Arguments {
  Campaign campaign;
  std::string check = "invariants";
  std::vector<std::string> names;
  std::string replay;
  double duration = 8;
  bool print = false;
};

std::string list_of_characters() {
  std::ostringstream text;
  text << "Characters:\n";
  for (const Character& character : characters())
    text << "  " << character.name << ": " << character.what << "\n";
  return text.str();
}

void declare(CLI::App& app, Arguments& arguments) {
  Campaign& campaign = arguments.campaign;
  app.add_option("--check", arguments.check,
                 "invariants, integrator (an independent one), relations (symmetries)")
      ->check(CLI::IsMember({"invariants", "integrator", "relations"}))
      ->capture_default_str();
  app.add_option("--seed", campaign.seed, "of all scenes")->capture_default_str();
  app.add_option("--first", campaign.first, "number of the first scene")->capture_default_str();
  app.add_option("--scenes", campaign.scenes, "how many")->capture_default_str();
  app.add_option("--seconds", campaign.seconds, "of wall time, after which no scene is begun; 0: no limit")
      ->capture_default_str();
  app.add_option("--cpu-limit", campaign.cpu_limit, "of a scene [s]: 60")->check(CLI::PositiveNumber);
  app.add_option("--processes", campaign.processes, "at a time")
      ->take_last()
      ->capture_default_str()
      ->check(CLI::Range(1, 64));
  app.add_option("--character", arguments.names, "only these characters");
  app.add_flag("--hostile", campaign.hostile, "with numbers at the ends of their ranges");
  app.add_flag("!--no-shrink", campaign.shrink, "print findings as they were generated");
  app.add_option("--keep", campaign.directory, "directory that findings are written to");
  app.add_option("--replay", arguments.replay, "judge this scene file alone")->check(CLI::ExistingFile);
  app.add_option("--duration", arguments.duration, "of --replay [s]")->capture_default_str();
  app.add_flag("--print", arguments.print, "print the scenes, judge none");
}

void choose_characters(Arguments& arguments) {
  for (const Character& character : characters()) {
    const auto& names = arguments.names;
    if (names.empty() || std::find(names.begin(), names.end(), character.name) != names.end())
      arguments.campaign.characters.push_back(character);
  }
  if (arguments.campaign.characters.empty()) throw CLI::ValidationError("--character", "no such character");
}

int replay(const Arguments& arguments) {
  const Case a_case{scene::read_scene_file(arguments.replay), arguments.duration};
  const Verdict verdict = judge_apart(arguments.campaign, a_case);
  std::cout << static_cast<char>(verdict.kind) << ": " << verdict.claim << ": " << verdict.words << "\n";
  return verdict.kind == Verdict::Kind::found ? 1 : 0;
}

void print_all(const Campaign& campaign) {
  for (std::uint64_t i = campaign.first; i < campaign.first + campaign.scenes; ++i) {
    std::string character;
    const Case a_case = case_of(campaign, i, &character);
    std::cout << "--- # seed " << campaign.seed << ", scene " << i << ", " << character << "\n"
              << text_of(a_case);
  }
}

int report(const Tally& tally) {
  const auto count = [&](Verdict::Kind kind) {
    const auto found = tally.kinds.find(static_cast<char>(kind));
    return found == tally.kinds.end() ? 0 : found->second;
  };
  const auto list = [](const char* what, const std::map<std::string, std::uint64_t>& counts) {
    for (const auto& [reason, times] : counts)
      std::cout << "  " << what << ", " << times << ": " << reason << "\n";
  };
  list("refused", tally.refusals);
  list("halted", tally.reasons);
  list("says nothing", tally.skips);
  list("FOUND", tally.findings);
  std::cout << tally.scenes << " scenes in " << tally.seconds << " s ("
            << 60 * static_cast<double>(tally.scenes) / tally.seconds
            << " a minute): " << count(Verdict::Kind::held) << " held, " << count(Verdict::Kind::halted)
            << " halted, " << count(Verdict::Kind::refused) << " refused, " << count(Verdict::Kind::skipped)
            << " say nothing, " << count(Verdict::Kind::found) << " findings\n";
  return tally.findings.empty() ? 0 : 1;
}

int main_of(int argc, char** argv) {
  CLI::App app("Judges generated scenes, each in its own process. Exit code 1 where a claim does not hold.");
  app.footer(list_of_characters());
  Arguments arguments;
  declare(app, arguments);
  try {
    app.parse(argc, argv);
    choose_characters(arguments);
  } catch (const CLI::ParseError& error) {
    return app.exit(error);
  }
  arguments.campaign.judge = judge_named(arguments.check);
  if (!arguments.replay.empty()) return replay(arguments);
  if (arguments.print) {
    print_all(arguments.campaign);
    return 0;
  }
  return report(run(arguments.campaign, std::cout));
}

}  // namespace
}  // namespace hybrid_sphere::fuzz

int main(int argc, char** argv) { return hybrid_sphere::fuzz::main_of(argc, argv); }
