#!/bin/bash
# Proposals of bash for beginnings of command lines.
# usage: check_completion.sh PROGRAM SCRIPT CASE.prm
program=$1 case=$3 failed=0
# shellcheck source=/dev/null
source "$2"

proposes() { # expected proposals in order, separated by "; ", then the words
  local expected=$1 found
  shift
  COMP_WORDS=("$program" "$@") COMP_CWORD=$#
  _voussoir
  found=$(printf '%s; ' "${COMPREPLY[@]}")
  if [ "${found%; }" = "$expected" ]; then
    echo "$*: $expected  ok"
  else
    echo "$*: ${found%; } instead of $expected  FAILED"
    failed=1
  fi
}

proposes "--defaults" --def
proposes "--restart" --re
proposes "json" --defaults j
proposes "materials; meshes" --list m
proposes 'Time/End\ time=' --set Time/En
proposes 'Materials/linear\ elastic/' --set 'Materials/linear\ el'
proposes "Time/End time=" --set '"Time/En'
proposes "Materials/concrete/Young\\'s\\ modulus=" "$case" --set Materials/concrete/You
proposes "Mesh/box/Cells=" "$case" --set "Time/End time=3" Mesh/box/Ce
proposes "$case" "${case%.prm}"
program=$program-run # the launcher
proposes "--restart" --re
exit $failed
