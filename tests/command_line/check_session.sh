#!/bin/bash
# Simultaneous runs do not share Open MPI's folder for sessions: a run starts where that
# folder cannot be made, and leaves nothing behind.
# usage: check_session.sh PROGRAM
failed=0
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
touch "$folder/ompi.$(hostname -s).$(id -u)" "$folder/ompi.$(hostname).$(id -u)"
before=$(ls "$folder")

is_true() { # what, command...
  if "${@:2}"; then echo "$1  ok"; else echo "$1  FAILED"; failed=1; fi
}

starts() { TMPDIR=$folder "$1" --list cases >/dev/null 2>&1; }
is_true "starts" starts "$1"
is_true "leaves nothing behind" [ "$(ls "$folder")" = "$before" ]
exit $failed
