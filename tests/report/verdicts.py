"""Output of the tests of this folder on the numbers that they compare."""

import sys

failed = []


def compare(what, value, reference, allowed, round_off=0.):
    """Prints a number and its reference, with the error that is allowed in per cent."""
    good = abs(value - reference) <= 0.01 * allowed * abs(reference) + round_off
    print(f"{what} = {value:.5g}  (reference {reference:.5g}, allowed {allowed:g} %)  "
          f"{'ok' if good else 'FAILED'}")
    if not good:
        failed.append(what)


def is_true(what, good):
    print(f"{what}  {'ok' if good else 'FAILED'}")
    if not good:
        failed.append(what)


def end():
    print(f"{len(failed)} failed" if failed else "all ok")
    sys.exit(1 if failed else 0)
