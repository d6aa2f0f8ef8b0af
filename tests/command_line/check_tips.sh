#!/bin/bash
# --validate notes the strength at tips of cracks: in cells of 80 m3 with
# E Gf / ft^2 = 3 m it is 1 / sqrt(1 + 80^(1/3) / 3) = 64.1 %.
# usage: check_tips.sh VOUSSOIR CASE
entry="Materials/concrete"
said=$("$1" "$2" --validate --set "$entry/Class=concrete damage" "$entry/Tensile strength=2e6" \
  "$entry/Fracture energy=400" "$entry/Crack growth=from tips" "Output/Observers=histories" 2>&1)
code=$?
expected="note: in concrete, at tips of cracks the tensile strength is lowered to 64.1 % in the largest cells, of 4.31 m, \
and to 64.1 % in the smallest, of 4.31 m; it is below half in cells larger than 9 m."
if [ $code -eq 0 ] && [ "$(grep -a '^note: in' <<<"$said")" = "$expected" ]; then
  echo "noted  ok"
else
  echo "exit code $code:"; echo "$said"; exit 1
fi
