#!/bin/bash
# A terminal shows a bar, which is gone in the end; a file and log.txt have plain lines.
# usage: check_progress.sh PROGRAM CASE.prm
program=$1 case=$2 failed=0
command -v script >/dev/null || { echo "skipped: there is no script"; exit 77; }
script -qec true /dev/null >/dev/null 2>&1 || { echo "skipped: no terminal can be made here"; exit 77; }
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
export TERM=xterm SHELL=/bin/bash

# the shell that starts it writes to the terminal, as that of a user does
shown() { # how its output is redirected, terminal
  TERM=$2 script -qec "$program $case --set Output/Folder=$folder/run 'Time/End time=20' --overwrite $1; true" \
    "$folder/terminal" >/dev/null
  tr '\r' '\n' <"$folder/terminal" | grep -ac '\[#*-*\] *[0-9.]* %'
}

is_true() { # what, command...
  if "${@:2}"; then echo "$1  ok"; else echo "$1  FAILED"; failed=1; fi
}

is_true "a bar on a terminal" [ "$(shown "" xterm)" -gt 0 ]
is_true "  which goes before the next line" grep -aqP '\r\x1b\[K[A-Z]' "$folder/terminal"
is_true "  not in log.txt" [ "$(grep -acP '[\r\x1b]' "$folder/run/log.txt")" -eq 0 ]
is_true "none in a file" [ "$(shown ">$folder/file" xterm)" -eq 0 ]
is_true "  which has plain lines" [ "$(grep -acP '[\r\x1b]' "$folder/file")" -eq 0 ]
is_true "none on a terminal that cannot overwrite" [ "$(shown "" dumb)" -eq 0 ]
exit $failed
