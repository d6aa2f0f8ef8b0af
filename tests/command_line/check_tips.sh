#!/bin/bash
# --validate notes the strength at tips of cracks: in cells of 80 m3 with
# E Gf / ft^2 = 3 m it is 1 / sqrt(1 + 80^(1/3) / 3) = 64.1 %, along planes
# with 1.5 times the size 56.3 %; and what one integration point in cells does to
# their cracks.
# usage: check_tips.sh VOUSSOIR CASE
entry="Materials/concrete"
concrete=("$entry/Class=concrete damage" "$entry/Tensile strength=2e6" "$entry/Fracture energy=400" \
  "Output/Observers=histories")
voussoir=$1
case=$2
# check NAME ENTRY EXPECTED
# ENTRY may be two, divided by a semicolon
check() {
  local said code entries
  IFS=';' read -ra entries <<<"$2"
  said=$("$voussoir" "$case" --validate --set "${concrete[@]}" "${entries[@]}" 2>&1)
  code=$?
  if [ $code -eq 0 ] && [ "$(grep -a '^note: in' <<<"$said")" = "$3" ]; then
    echo "$1  ok"
  else
    echo "$1: exit code $code:"; echo "$said"; exit 1
  fi
}
of_tips="note: in concrete, at tips of cracks the tensile strength is lowered to 64.1 % in the largest cells, of 4.31 m, \
and to 64.1 % in the smallest, of 4.31 m; it is below half in cells larger than 9 m."
of_one_point="note: in concrete, cells with one integration point keep their stiffness against bending when they crack, so \
that a crack whose sides turn against each other keeps most of its load; with \"Quadrature = one point where elastic\" they have eight, \
and with \"Crack growth = along planes\", where the class has it, a crack takes this stiffness."
of_planes="note: in concrete, at tips of cracks the tensile strength is lowered to 56.3 % in the largest cells, of 4.31 m, \
and to 56.3 % in the smallest, of 4.31 m; it is below half in cells larger than 6 m."
check "tips" "$entry/Crack growth=from tips" "$of_tips"
check "one point" "Discretization/Quadrature=one point" "$of_one_point"
check "one point where elastic" "Discretization/Quadrature=one point where elastic" ""
check "planes" "$entry/Crack growth=along planes;Discretization/Quadrature=one point" "$of_planes"
