#!/bin/bash
# Cases that come with the program are found by name if there is no file of that name,
# and the man page has all options of the program.
# usage: check_shipped.sh PROGRAM SOURCES
program=$1 sources=$2 failed=0
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1

says() { # what is expected in the output, then the arguments
  local expected=$1
  shift
  if "$program" "$@" 2>&1 | grep -qF -- "$expected"; then
    echo "$*: $expected  ok"
  else
    echo "$*: not $expected  FAILED"
    failed=1
  fi
}

title=$(sed -n 's/^set Title = //p' "$sources/prm/quickstart.prm")
says "set Title = $title" quickstart.prm --defaults short
says "set Title = $title" prm/quickstart.prm --defaults short
says "the shipped case is taken: $sources/prm/quickstart.prm" quickstart.prm --defaults short
says "\"../prm/quickstart.prm\" cannot be read" ../prm/quickstart.prm --defaults short
says "\"no_such_case.prm\" cannot be read" no_such_case.prm --defaults short
says "benchmarks/throughput.prm: " --list cases
# a file of the user takes precedence
sed "s/^set Title = .*/set Title = mine/" "$sources/prm/quickstart.prm" >quickstart.prm
says "set Title = mine" quickstart.prm --defaults short

for option in $("$program" --help | grep -oE -- '--[a-z][a-z-]+' | sort -u); do
  grep -qF -- "${option//-/\\-}" "$sources/source/package/voussoir.1.in" && continue
  echo "the man page has no $option  FAILED"
  failed=1
done
exit $failed
