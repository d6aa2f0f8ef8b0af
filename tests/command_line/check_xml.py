#!/usr/bin/python3
"""Reads the output of "--defaults xml" as deal.II's parameter_gui does: an element
whose first child is <value> is an entry, and has the children that the editor needs and
no others. The editor would take further children for entries below it, and lose the
entry when the file is saved.

usage: check_xml.py PROGRAM CASE.prm
"""

import re
import subprocess
import sys
import xml.etree.ElementTree

program, case = sys.argv[1:]
text = subprocess.run([program, case, "--defaults", "xml"], check=True, stdout=subprocess.PIPE).stdout
entries, failed = {}, []


def name_of(tag):
    """ "_20" stands for the character 0x20."""
    return re.sub("_(..)", lambda code: chr(int(code[1], 16)), tag)


def read(element, path):
    children = [child.tag for child in element]
    if children[:1] != ["value"]:
        for child in element:
            read(child, [*path, name_of(child.tag)])
        return
    name = "/".join(path)
    entries[name] = element.findtext("value")
    if children != ["value", "default_value", "documentation", "pattern", "pattern_description"]:
        failed.append(f"{name} has {children}")
    pattern = element.findtext("pattern_description")
    if re.match(r"\[(Integer|Double)", pattern) and "..." not in pattern:
        failed.append(f"{name} has no range, as {pattern}: its editor fails")


read(xml.etree.ElementTree.fromstring(text), [])
for what, value, expected in (("Materials/concrete/Density", float(entries["Materials/concrete/Density"]), 2400.),
                              ("Materials/Names", entries["Materials/Names"], "concrete"),
                              ("Time/End time", float(entries["Time/End time"]), 3.)):
    print(f"{what} = {value}  {'ok' if value == expected else 'FAILED'}")
    if value != expected:
        failed.append(what)
print(f"{len(entries)} entries, {len(failed)} failed", *failed[:5], sep="\n  ")
sys.exit(1 if failed or len(entries) < 100 else 0)
