"""Writes SPIR-V's types and functions as C++ over the lane types of src/trace/lanes/lanes.h."""
from variables import Variables

# Records of tables: a value is the place where each lane finds its own. Shared: there is one for all lanes.
RECORDS = {'InstanceData', 'MaterialData', 'LightData', 'KernelGeometry', 'KernelEmitter', 'KernelLightNode', 'TextureRef'}
SHARED_RECORDS = {'KernelFrame', 'SkyData'}

BINARY = {'FAdd': '+', 'FSub': '-', 'FMul': '*', 'FDiv': '/', 'IAdd': '+', 'ISub': '-', 'IMul': '*',
          'VectorTimesScalar': '*', 'BitwiseAnd': '&', 'BitwiseOr': '|', 'BitwiseXor': '^', 'ShiftLeftLogical': '<<',
          'ShiftRightLogical': '>>', 'FOrdEqual': '==', 'FUnordNotEqual': '!=', 'FOrdLessThan': '<',
          'FOrdGreaterThan': '>', 'FOrdLessThanEqual': '<=', 'FOrdGreaterThanEqual': '>=', 'IEqual': '==',
          'INotEqual': '!=', 'ULessThan': '<', 'UGreaterThan': '>', 'ULessThanEqual': '<=', 'UGreaterThanEqual': '>='}
CALLED = {'UDiv': 'divide', 'UMod': 'modulo', 'LogicalAnd': 'both', 'LogicalOr': 'either', 'LogicalNot': 'no',
          'LogicalNotEqual': 'differ', 'Select': 'select', 'Dot': 'dot', 'Any': 'any_of', 'All': 'all_of',
          'ConvertUToF': 'to_float', 'ConvertFToU': 'to_uint', 'FNegate': '-', 'Not': '~',
          'BitReverse': 'reverse_bits'}
# GLSL.std.450
STANDARD = {4: 'abs', 6: 'sign', 8: 'floor', 10: 'fract', 13: 'sin', 14: 'cos', 15: 'tan', 16: 'asin', 17: 'acos',
            18: 'atan', 25: 'atan2', 26: 'pow', 27: 'exp', 28: 'log', 29: 'exp2', 30: 'log2', 31: 'sqrt',
            32: 'inversesqrt', 37: 'min', 38: 'min', 40: 'max', 41: 'max', 43: 'clamp', 44: 'clamp', 46: 'mix',
            49: 'smoothstep', 66: 'length', 68: 'cross', 69: 'normalize'}


class Types:
    def __init__(self, module):
        self.module = module

    def text(self, type_id):
        """The C++ type of a value that differs from lane to lane."""
        t = self.module.types[type_id]
        if t.name == 'TypePointer':
            return self.text(t.operands[1])
        if t.name == 'TypeVector':
            return 'Vec%d<%s>' % (t.operands[1], self.text(t.operands[0]))
        if t.name == 'TypeStruct':
            name = self.module.names[type_id]
            return name + 'Ref' if name in RECORDS | SHARED_RECORDS else name
        if t.name == 'TypeInt':
            return 'Int' if t.operands[1] else 'Uint'
        return {'TypeVoid': 'void', 'TypeBool': 'Mask', 'TypeFloat': 'Float', 'TypeMatrix': 'Mat4'}[t.name]

    def member(self, type_id, index):
        """('.member', its type)"""
        t = self.module.types[type_id]
        if t.name == 'TypePointer':
            return self.member(t.operands[1], index)
        if t.name == 'TypeVector':
            return '.' + 'xyzw'[index], t.operands[0]
        if t.name == 'TypeMatrix':
            return '.column[%d]' % index, t.operands[0]
        if t.name == 'TypeArray':  # of a shared record
            return '[%d]' % index, t.operands[0]
        call = '()' if self.module.names[type_id] in RECORDS | SHARED_RECORDS else ''
        return '.' + self.module.member_names[type_id, index] + call, t.operands[index]

    def structs(self):
        out = []
        for id_, t in self.module.types.items():
            if t.name == 'TypeStruct':
                members = [(self.module.member_names[id_, n], m) for n, m in enumerate(t.operands)]
                name = self.module.names[id_]
                out += self.record(name, members) if name in RECORDS | SHARED_RECORDS else self.struct(name, members)
        return '\n'.join(out)

    def record(self, name, members):
        base = 'Record' if name in RECORDS else 'SharedRecord'
        out = ['struct %sRef : %s<shading::%s> {' % (name, base, name)]
        for member, type_ in members:
            where = 'offsetof(shading::%s, %s)' % (name, member)
            if self.module.types[type_].name == 'TypeStruct':
                ref = self.text(type_)
                out.append('    %s %s() const { return {base + %s, offset}; }' % (ref, member, where))
            else:
                out.append('    auto %s() const { return get<decltype(shading::%s::%s), %s>(); }' % (member, name, member, where))
        return out + ['};']

    def struct(self, name, members):
        out = ['struct %s {' % name]
        out += ['    %s %s;' % (self.text(type_), member) for member, type_ in members]
        out += ['};', 'inline void assign(Mask m, %s& to, const %s& from) {' % (name, name)]
        out += ['    assign(m, to.%s, from.%s);' % (member, member) for member, _ in members]
        return out + ['}']


class FunctionText:
    """One function. `m` is the mask of active lanes: branches run under a narrower one, and not at all where no lane is
    active; what leaves a branch early (return, break, continue) takes its lanes out of the mask."""

    def __init__(self, module, types, function):
        self.module, self.types, self.f = module, types, function
        self.variables = Variables(module, function)
        self.lines, self.indent, self.returns = [], 1, 0
        self.returns_in_loop = any(function.innermost_loop(i.place) for i in function.of('Return') + function.of('ReturnValue'))

    def put(self, text):
        self.lines.append('    ' * self.indent + text)

    def open(self, text):
        self.put(text)
        self.indent += 1

    def close(self):
        self.indent -= 1
        self.put('}')

    # -- names

    def name(self, id_):
        text = ''.join(c if c.isalnum() else '_' for c in self.module.names.get(id_, ''))
        return '%s_%d' % (text or 'v', id_)

    def value(self, id_):
        if id_ in self.module.constant_text:
            return self.module.constant_text[id_]
        if id_ in self.variables.alias:
            return self.lvalue(self.variables.alias[id_])
        return self.name(id_)

    def values(self, ids):
        return ', '.join(self.value(id_) for id_ in ids)

    def lvalue(self, pointer):
        root, path = self.variables.path(pointer)
        named = self.variables.named
        return self.members(self.value(named[root]) if root in named else self.name(root), self.module.value_types[root], path)

    def members(self, text, type_, path):
        for index in path:
            member, type_ = self.types.member(type_, index)
            text += member
        return text

    def components(self, id_):
        t = self.module.types[self.module.value_types[id_]]
        count = t.operands[1] if t.name == 'TypeVector' else 0
        return [self.value(id_) + '.' + 'xyzw'[n] for n in range(count)] or [self.value(id_)]

    # -- instructions

    def define(self, i, text):
        self.put('const auto %s = %s;' % (self.name(i.id), text))

    def emit(self, i):
        o = i.operands
        if i in self.variables.skipped or i.name in ('Variable', 'AccessChain', 'SelectionMerge', 'LoopMerge', 'Phi'):
            return
        if i.name == 'Load':
            if i.id not in self.variables.alias:
                self.define(i, self.lvalue(o[0]))
        elif i.name == 'Store':
            how = 'assign(m, %s, %s);' if self.variables.needs_mask(i) else 'put(%s, %s);'
            self.put(how % (self.lvalue(o[0]), self.value(o[1])))
        elif i.name == 'FunctionCall':
            self.emit_call(i)
        elif i.name == 'ExtInst' and o[1] in STANDARD:
            self.define(i, '%s(%s)' % (STANDARD[o[1]], self.values(o[2:])))
        elif i.name == 'CompositeExtract':
            self.define(i, self.members(self.value(o[0]), self.module.value_types[o[0]], o[1:]))
        elif i.name == 'CompositeConstruct':
            self.define(i, 'vec(%s)' % ', '.join(c for a in o for c in self.components(a)))
        elif i.name == 'VectorShuffle':
            both = self.components(o[0]) + self.components(o[1])
            self.define(i, 'vec(%s)' % ', '.join(both[n] for n in o[2:]))
        elif i.name == 'Bitcast':
            self.define(i, 'bits_to_%s(%s)' % (self.types.text(i.type).lower(), self.value(o[0])))
        elif i.name in BINARY:
            self.define(i, '%s %s %s' % (self.value(o[0]), BINARY[i.name], self.value(o[1])))
        elif i.name in CALLED:
            self.define(i, '%s(%s)' % (CALLED[i.name], self.values(o)))
        else:
            raise SystemExit('no translation of Op%s %s in %s' % (i.name, o, self.f.name))

    def emit_call(self, i):
        callee = self.module.functions[i.operands[0]]
        arguments = ['k', 'm']
        for n, a in enumerate(i.operands[1:]):
            at = i.place, n
            if at in self.variables.by_reference or (at not in self.variables.by_value and self.module.is_pointer(a)):
                arguments.append(self.lvalue(self.variables.by_reference.get(at, a)))
            else:
                arguments.append('lift(%s)' % self.value(self.variables.by_value.get(at, a)))
        call = '%s(%s)' % (callee.name, ', '.join(arguments))
        if i.id not in self.f.uses:
            self.put(call + ';')
        else:
            self.define(i, call)

    # -- control

    def leaves(self, label, stop, loop):
        """True where lanes that enter at `label` need not all arrive at `stop`."""
        seen, todo = set(), [label]
        while todo:
            label = todo.pop()
            if label == stop or label in seen:
                continue
            seen.add(label)
            end = self.f.blocks[label][-1]
            if end.name in ('Return', 'ReturnValue') or (loop and label in loop):
                return True
            todo += {'Branch': end.operands[:1], 'BranchConditional': end.operands[1:3]}.get(end.name, [])
        return False

    def is_short(self, label, stop):
        """Straight to `stop` by instructions that are cheaper than asking whether any lane wants them."""
        block = self.f.blocks[label]
        return (block[-1].name == 'Branch' and block[-1].operands[0] == stop and len(block) <= 10 and
                not any(i.name in ('FunctionCall', 'ExtInst') for i in block))

    def emit_phis(self, source, target, how):
        """What a value of `target` is for lanes that come from `source`."""
        for i in self.f.blocks[target]:
            if i.name == 'Phi' and source in i.operands[1::2]:
                self.put(how % (self.name(i.id), self.value(i.operands[i.operands[1::2].index(source) * 2])))

    def emit_blocks(self, label, stop, loop):
        """From `label` up to `stop`; `loop` is (merge, continue) of the loop around."""
        opened = 0
        while label != stop:
            for i in self.f.blocks[label][:-1]:
                self.emit(i)
            merge, end = self.f.merge_of(label), self.f.blocks[label][-1]
            left = False
            if merge is not None and merge.name == 'LoopMerge':
                self.emit_loop(label, merge, end)
                label, left = merge.operands[0], self.returns_in_loop
            elif end.name == 'BranchConditional' and merge is not None:
                left = self.emit_selection(label, merge.operands[0], end, loop)
                label = merge.operands[0]
            elif end.name == 'Branch' and (end.operands[0] == stop or not (loop and end.operands[0] in loop)):
                self.emit_phis(label, end.operands[0], 'assign(m, %s, %s);')
                label = end.operands[0]
            else:
                self.emit_leave(end, loop)
                break
            if left and self.f.blocks[label][-1].name == 'Unreachable':
                break
            if left:
                self.open('if (any(m)) {')
                opened += 1
        for _ in range(opened):
            self.close()

    def emit_leave(self, end, loop):
        if end.name == 'BranchConditional':
            raise SystemExit('a branch without a merge in ' + self.f.name)
        if end.name == 'Unreachable':
            return
        if end.name == 'ReturnValue' and not self.variables.returned:
            first = self.returns == 0 and self.f.innermost_loop(end.place) is None
            self.put(('put(result, %s);' if first else 'assign(m, result, %s);') % self.value(end.operands[0]))
            self.returns += 1
        if end.name == 'Branch' and end.operands[0] == loop[1]:
            self.put('continued = continued | m;')
        if end.name != 'Branch' and self.returns_in_loop:
            self.put('returned = returned | m;')
        self.put('m = Mask{};')

    def emit_selection(self, label, merge, end, loop):
        """True where lanes may have left."""
        condition, *branches = end.operands[:3]
        for i in self.f.blocks[merge]:
            if i.name == 'Phi':
                self.put('%s %s;' % (self.types.text(i.type), self.name(i.id)))
        self.emit_phis(label, merge, 'put(%s, %s);')
        self.put('const Mask before_%d = m, is_%d = as_mask(%s);' % (label, label, self.value(condition)))
        masks = ['before_%d & is_%d' % (label, label), 'before_%d & ~is_%d' % (label, label)]
        leaves = [b != merge and self.leaves(b, merge, loop) for b in branches]
        stayed = ['stayed_%d_%d' % (label, n) if leaves[n] else '(%s)' % masks[n] for n in range(2)]
        for n, branch in enumerate(branches):
            if branch == merge:
                continue
            self.put('m = %s;' % masks[n])
            self.open('{' if self.is_short(branch, merge) else 'if (any(m)) {')
            self.emit_blocks(branch, merge, loop)
            self.close()
            if leaves[n]:
                self.put('const Mask %s = m;' % stayed[n])
        self.put('m = %s;' % (' | '.join(stayed) if any(leaves) else 'before_%d' % label))
        return any(leaves)

    def emit_loop(self, label, merge, end):
        after, going_on = merge.operands[:2]
        self.put('const Mask before_%d = m;' % label)
        self.open('while (true) {')
        if end.name == 'Branch':
            for i in self.f.blocks[end.operands[0]][:-1]:
                self.emit(i)
            end = self.f.blocks[end.operands[0]][-1]
        if end.name != 'BranchConditional' or end.operands[2] != after:
            raise SystemExit('a loop that does not begin with its test in ' + self.f.name)
        self.put('m = m & as_mask(%s);' % self.value(end.operands[0]))
        self.put('if (!any(m)) break;')
        self.put('[[maybe_unused]] Mask continued{};')
        self.emit_blocks(end.operands[1], going_on, (after, going_on))
        self.put('m = m | continued;')
        self.emit_blocks(going_on, label, None)
        self.close()
        self.put('m = before_%d%s;' % (label, ' & ~returned' if self.returns_in_loop else ''))

    # -- the whole

    def head(self):
        parameters = ['[[maybe_unused]] const LaneScene& k', '[[maybe_unused]] Mask m']
        for n, p in enumerate(self.f.parameters):
            key = self.f.id, n
            how = '%s %s' if key in self.module.taken else '%s& %s' if self.module.written[key] else 'const %s& %s'
            parameters.append(how % (self.types.text(p.type), self.name(p.id)))
        return 'static %s %s(%s)' % (self.types.text(self.f.type), self.f.name, ', '.join(parameters))

    def text(self):
        self.emit_blocks(self.f.body[0].id, None, None)
        body, self.lines = self.lines, []
        if self.module.types[self.f.type].name != 'TypeVoid':
            result = self.variables.returned
            if not result:
                self.put(self.types.text(self.f.type) + ' result;')
            body.append('    return %s;' % (self.name(result) if result else 'result'))
        if self.returns_in_loop:
            self.put('Mask returned{};')
        for i in self.f.of('Variable'):
            if i.id not in self.variables.named and (i.id == self.variables.returned or self.variables.accesses(i.id)):
                self.put('%s %s;' % (self.types.text(i.type), self.name(i.id)))
        return '\n'.join([self.head() + ' {'] + self.lines + body + ['}'])
