# The gates that .ci/run and scripts/check share; both source this file in the root of the repository.
# shellcheck shell=bash

passed=0 failed=0
times=()
output=$(mktemp)
trap 'rm -f "$output"' EXIT
begin=$SECONDS

# Runs a gate: its name, then the command. Prints the time it took, and its output when it fails.
gate() {
  local name=$1 start=$SECONDS result=passed
  shift
  echo "== $name"
  if "$@" >"$output" 2>&1; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    result=FAILED
    cat "$output"
  fi
  echo "   $result in $((SECONDS - start)) s"
  times+=("$(printf '%6d  %s' $((SECONDS - start)) "$name")")
}

shell_syntax() {
  local file result=0
  while IFS= read -r file; do
    bash -n "$file" || result=1
  done < <(git grep -lE '^#!/usr/bin/env bash' -- scripts benchmark .ci)
  return $result
}

cpp_format() {
  git ls-files -z -- '*.cpp' '*.hpp' | xargs -0 -r clang-format --dry-run --Werror
}

# Errors and warnings fail. The build directories hold generated package files that are not ours to check; scripts/
# holds commands of the repository, which a user of the installed package does not need.
package_lint() {
  env -u ROS_PACKAGE_PATH catkin_lint --offline --strict --skip-path build --skip-path devel --ignore uninstalled_script .
}

# README.md or a page of docs/ names every message, service, launch file and rostest.
documented_names() {
  local file name result=0
  while IFS= read -r file; do
    name=$(basename "$file")
    name=${name%.msg}
    name=${name%.srv}
    if ! grep -qF -- "$name" README.md docs/*.md; then
      echo "neither README.md nor docs/ names $file"
      result=1
    fi
  done < <(git ls-files -- 'msg/*.msg' 'srv/*.srv' 'launch/*.launch' 'test/ros/*.test')
  return $result
}

# The libraries of the core include no ROS header: arrows run ros, cli -> simulation -> ground -> motion -> sphere -> scene.
core_without_ros() {
  ! git grep -nE '#include *[<"]((ros|tf2?|tf2_ros|[a-z_]+_msgs|std_srvs|rosbag)/|hybrid_sphere/[A-Z])' -- \
    src include ':!src/ros'
}

# The engine for any Lagrangian system includes nothing of the sphere, and only the programs include the catalogue.
mechanics_alone() {
  ! git grep -nE '#include *"(hybrid_sphere/)?(catalogue|cli|geometry|ground|motion|scene|simulation|sphere)/' -- \
    src/mechanics include/hybrid_sphere/mechanics src/integration src/interrupt
}

public_headers_alone() {
  ! git grep -nE '#include *"' -- include | grep -v '"hybrid_sphere/'
}

# The gates that compile nothing.
static_gates() {
  gate "shell syntax" shell_syntax
  gate "C++ format" cpp_format
  gate "catkin_lint" package_lint
  gate "documents name every message, service, launch file and rostest" documented_names
  gate "README.md is short" .ci/gates/readme_is_short
  gate "tests measure no time" .ci/gates/no_clocks_in_tests
  gate "doxygen reads the headers without a warning" scripts/build_api_docs
  gate "the core includes no ROS header" core_without_ros
  gate "the engine for any system includes nothing of the sphere" mechanics_alone
  gate "public headers include no private one" public_headers_alone
}

# Runs every test and adds its counts.
run_tests() {
  local start=$SECONDS result
  echo "== tests"
  bash scripts/test 2>&1 | tee "$output" | sed '$d' | grep -vE '^ +(Start +[0-9]+:|[0-9]+/[0-9]+ Test +#[0-9]+: .* Passed )'
  result=${PIPESTATUS[0]}
  if [[ $(tail -n 1 "$output") =~ ^([0-9]+)\ passed,\ ([0-9]+)\ failed$ ]]; then
    passed=$((passed + BASH_REMATCH[1]))
    failed=$((failed + BASH_REMATCH[2]))
    if [ "$result" -ne 0 ] && [ "${BASH_REMATCH[2]}" -eq 0 ]; then
      failed=$((failed + 1))
    fi
  else
    tail -n 1 "$output"
    failed=$((failed + 1))
  fi
  times+=("$(printf '%6d  tests' $((SECONDS - start)))")
}

# Prints the times of the gates and the counts; the exit code is 0 exactly when nothing failed.
finish() {
  echo "time of each gate [s]"
  printf '%s\n' "${times[@]}" "$(printf '%6d  all' $((SECONDS - begin)))"
  echo "$passed passed, $failed failed"
  [ "$failed" -eq 0 ]
}
