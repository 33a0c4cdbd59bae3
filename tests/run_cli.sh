#!/usr/bin/env bash
# Usage: run_cli.sh FOLDER EXPECTED_EXIT_CODE EXPECTED_REGEX COMMAND...
#
# Runs COMMAND in a fresh FOLDER; its exit code must be the expected one, and a line that it prints must match.
set -u
folder=$1 expected_code=$2 expected_regex=$3
shift 3
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=tests/prepare_run.sh
. "$tests/prepare_run.sh"

"$@" >stdout 2>&1 </dev/null
code=$?
echo "$*"
cat stdout
if ((code != expected_code)); then
  echo "FAILED: exit code $code, expected $expected_code"
  exit 1
fi
if ! grep -qE -e "$expected_regex" stdout; then
  echo "FAILED: no line matches '$expected_regex'"
  exit 1
fi
