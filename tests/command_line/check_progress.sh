#!/bin/bash
# A terminal shows a progress bar, which disappears at the end; a file and log.txt have
# plain lines.
# usage: check_progress.sh PROGRAM CASE.prm
program=$1 case=$2 failed=0
command -v script >/dev/null || { echo "skipped: there is no script"; exit 77; }
script -qec true /dev/null >/dev/null 2>&1 || { echo "skipped: no terminal can be made here"; exit 77; }
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
export TERM=xterm SHELL=/bin/bash

bar='\[#*-*\] *[0-9.]* %'

# the shell that starts the program writes to the terminal, as that of a user does
run_on() { # terminal, how its output is redirected
  rm -f "$folder/terminal" "$folder/file"
  TERM=$1 script -qec "$program $case --set Output/Folder=$folder/run 'Time/End time=20' --overwrite $2; true" \
    "$folder/terminal" >/dev/null
}

# lines with a pattern, which "\r" ends, too; nothing if there is no file
lines() { # pattern, file
  [ -f "$2" ] && tr '\r' '\n' <"$2" | grep -acP "$1"
}

is_true() { # what, command...
  if "${@:2}"; then echo "$1  ok"; else echo "$1  FAILED"; failed=1; fi
}

run_on xterm ""
is_true "a bar on a terminal" [ "$(lines "$bar" "$folder/terminal")" -gt 0 ]
is_true "  which goes before the next line" grep -aqP '\r\x1b\[K[A-Z]' "$folder/terminal"
is_true "  not in log.txt" [ "$(grep -acP '[\r\x1b]' "$folder/run/log.txt")" = 0 ]
run_on xterm ">$folder/file"
is_true "none in a file" [ "$(lines "$bar" "$folder/file")" = 0 ]
is_true "  which has plain lines" [ "$(grep -acP '[\r\x1b]' "$folder/file")" = 0 ]
is_true "  to the end of the run" [ "$(lines '^Done:' "$folder/file")" = 1 ]
run_on dumb ""
is_true "none on a terminal that cannot overwrite" [ "$(lines "$bar" "$folder/terminal")" = 0 ]
is_true "  which has the run to its end" [ "$(lines '^Done:' "$folder/terminal")" = 1 ]
exit $failed
