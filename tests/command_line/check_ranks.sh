#!/bin/bash
# More ranks than cells are refused in one sentence.
# usage: check_ranks.sh VOUSSOIR-RUN CASE
message=$("$1" -n 3 "$2" --validate --set "Mesh/box/Cells=1, 1, 2" 2>&1)
code=$?
expected="Error: The mesh has 2 cells, fewer than the 3 ranks; take fewer ranks, or smaller cells."
if [ $code -eq 1 ] && [ "$(grep -a '^Error' <<<"$message")" = "$expected" ]; then
  echo "refused  ok"
else
  echo "exit code $code:"; echo "$message"; exit 1
fi
