#!/usr/bin/env python3
"""Translates functions of a SPIR-V module to C++ that computes them for eight lanes at a time.

    translate.py MODULE.spv FUNCTION… --answers fetch.h -o kernel.inl

Control flow becomes masks (Karrenberg & Hack 2011, "Whole-Function Vectorization"): all lanes run the same
instructions, those that a branch is not for keep what they had. What all lanes share stays scalar, by C++'s own types.
Functions that the header of --answers has are C++'s: their bodies in the module do not count.
"""
import argparse
import re

import cpp
import spirv


def needed_functions(module, roots, answered):
    needed, todo = set(), [f.id for f in module.functions.values() if f.name in roots]
    while todo:
        f = module.functions[todo.pop()]
        if f.id not in needed and f.name not in answered:
            needed.add(f.id)
            todo += [i.operands[0] for i in f.of('FunctionCall')]
    return [f for f in module.functions.values() if f.id in needed]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('module')
    parser.add_argument('functions', nargs='+')
    parser.add_argument('--answers', required=True)
    parser.add_argument('-o', dest='output', required=True)
    arguments = parser.parse_args()
    with open(arguments.module, 'rb') as file:
        module = spirv.Module(file.read())
    with open(arguments.answers) as file:
        answered = set(re.findall(r'inline \w[\w<>]* (\w+)\(const LaneScene&', file.read()))
    functions = needed_functions(module, arguments.functions, answered)
    missing = set(arguments.functions) - {f.name for f in functions}
    if missing:
        raise SystemExit('%s: no function %s' % (arguments.module, ', '.join(sorted(missing))))
    types = cpp.Types(module)
    texts = [cpp.FunctionText(module, types, f) for f in functions]
    with open(arguments.output, 'w') as file:
        print('// Made from the kernel\'s SPIR-V by tools/lanes/translate.py.', types.structs(),
              '#include "trace/lanes/fetch.h"', *(t.head() + ';' for t in texts), *(t.text() for t in texts),
              sep='\n', file=file)


main()
