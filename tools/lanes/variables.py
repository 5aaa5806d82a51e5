"""Which of a function's variables C++ needs, and which of its stores need a mask."""
import itertools


class Variables:
    """What glslang makes of `const float x = …`, of parameters and of copies around calls, without the variables.

    by_value[place, n]      value that argument n of the call at a place simply is
    by_reference[place, n]  variable that it changes in place
    named[variable]         value that a variable merely names
    alias[value]            pointer to what a load of a whole structure need not copy
    skipped                 instructions that are done with so
    """

    def __init__(self, module, function):
        self.module, self.f = module, function
        self.skipped, self.by_value, self.by_reference, self.named, self.alias = set(), {}, {}, {}, {}
        self.parameters = {p.id for p in function.parameters}
        self.own = {p.id for n, p in enumerate(function.parameters) if (function.id, n) in module.taken}
        self.nest = {}  # branches and loops that each place is in
        self.find_nests(function.body[0].id, None, None, ())
        self.find_copies()
        self.returned = self.find_returned()
        self.find_named()
        self.find_aliases()

    def root(self, pointer):
        return self.f.path(self.module, pointer)[0]

    def path(self, pointer):
        return self.f.path(self.module, pointer)

    def find_nests(self, label, stop, loop, nest):
        f = self.f
        while label != stop:
            merge, end = f.merge_of(label), f.blocks[label][-1]
            if merge is not None and merge.name == 'LoopMerge':
                inner = nest + (('loop', label),)
                test = end.operands[0] if end.name == 'Branch' else label
                for i in f.blocks[label] + f.blocks[test]:
                    self.nest[i.place] = inner
                self.find_nests(f.blocks[test][-1].operands[1], merge.operands[1], merge.operands[:2], inner)
                self.find_nests(merge.operands[1], label, None, inner)
                label = merge.operands[0]
                continue
            for i in f.blocks[label]:
                self.nest[i.place] = nest
            if end.name == 'BranchConditional':
                for n, branch in enumerate(end.operands[1:3]):
                    if branch != merge.operands[0]:
                        self.find_nests(branch, merge.operands[0], loop, nest + ((label, n),))
                label = merge.operands[0]
            elif end.name == 'Branch' and not (loop and end.operands[0] in loop):
                label = end.operands[0]
            else:
                return

    def accesses(self, variable):
        """[(place, writes, path, instruction)] in order; a call that changes an argument writes it."""
        found = []
        for i in self.f.body:
            if i in self.skipped:
                continue
            if i.name in ('Load', 'Store'):
                root, path = self.path(i.operands[0])
                if root == variable:
                    found.append((i.place, i.name == 'Store', path, i))
            elif i.name == 'FunctionCall':
                for n, a in enumerate(i.operands[1:]):
                    if self.module.is_pointer(a) and (i.place, n) not in self.by_value:
                        root, path = self.path(self.by_reference.get((i.place, n), a))
                        key = i.operands[0], n
                        if root == variable:
                            found.append((i.place, self.module.written[key] and key not in self.module.taken, path, i))
        return found

    def find_copies(self):
        users = {}
        for i in self.f.body:
            pointers = {'Load': i.operands[:1], 'Store': i.operands[:1], 'FunctionCall': i.operands[1:]}.get(i.name, [])
            for p in pointers:
                if self.module.is_pointer(p):
                    users.setdefault(self.root(p), []).append(i)
        for call in self.f.of('FunctionCall'):
            for n, a in enumerate(call.operands[1:]):
                if self.f.definition.get(a) is not None and self.f.definition[a].name == 'Variable':
                    self.find_copy(call, n, a, users)

    def find_copy(self, call, n, variable, users):
        """One argument: copied in and no more, or copied out of and back into another variable."""
        key = call.operands[0], n
        stores = [u for u in users[variable] if u.name == 'Store']
        loads = [u for u in users[variable] if u.name == 'Load']
        whole = not any(self.path(u.operands[0])[1] for u in stores + loads)
        if not whole or len(users[variable]) != 1 + len(stores) + len(loads) or len(stores) > 1:
            return
        if any(u.block != call.block for u in stores + loads):
            return
        if not self.module.written[key] or key in self.module.taken:
            if stores and not loads:
                self.by_value[call.place, n] = stores[0].operands[1]
                self.skipped.add(stores[0])
            return
        back = self.f.uses.get(loads[0].id, []) if len(loads) == 1 else []
        if len(back) != 1 or back[0].name != 'Store' or back[0].block != call.block:
            return
        target, mine = back[0].operands[0], set(stores + loads + back + [call])
        first = call.place
        if stores:
            source = self.f.definition.get(stores[0].operands[1])
            if (source is None or source.name != 'Load' or source.block != call.block or
                    self.path(source.operands[0]) != self.path(target) or len(self.f.uses[source.id]) != 1):
                return
            first = source.place
            mine.add(source)
        if any(first <= u.place <= back[0].place and u not in mine for u in users.get(self.root(target), [])):
            return
        self.by_reference[call.place, n] = target
        self.skipped |= mine - {call}

    def find_returned(self):
        """The variable, if there is one, that every return returns: it is the result, which lanes that have left keep."""
        roots = set()
        for i in self.f.of('ReturnValue'):
            load = self.f.definition.get(i.operands[0])
            if load is None or load.name != 'Load' or load.block != i.block or self.f.definition.get(load.operands[0]) is None:
                return None
            variable = self.f.definition[load.operands[0]]
            stores = any(load.place < a[0] < i.place and a[1] for a in self.accesses(load.operands[0]))
            if variable.name != 'Variable' or stores or len(self.f.uses[load.id]) != 1:
                return None
            roots.add(variable.id)
        if len(roots) != 1 or len(self.f.of('ReturnValue')) < 2:
            return None
        for i in self.f.of('ReturnValue'):
            self.skipped.add(self.f.definition[i.operands[0]])
        return roots.pop()

    def find_named(self):
        """Variables stored once, as a whole, before and around all that reads them."""
        for v in self.f.of('Variable'):
            if v.id == self.returned:
                continue
            accesses = self.accesses(v.id)
            writes = [a for a in accesses if a[1]]
            if len(writes) != 1 or writes[0][3].name != 'Store' or writes[0][2]:
                continue
            place, store = writes[0][0], writes[0][3]
            nest = self.nest[place]
            if all(a[0] >= place and self.nest[a[0]][:len(nest)] == nest for a in accesses):
                self.named[v.id] = store.operands[1]
                self.skipped.add(store)

    def find_aliases(self):
        """Loads of whole structures that nobody changes before their last use."""
        for i in self.f.of('Load'):
            if i in self.skipped or self.module.types[i.type].name not in ('TypeStruct', 'TypeMatrix'):
                continue
            root = self.root(i.operands[0])
            writes = [a[0] for a in self.accesses(root) if a[1]]
            users = self.f.uses.get(i.id, [])
            last = max([u.place for u in users] + [k[0] for k, v in self.by_value.items() if v == i.id], default=i.place)
            loop = self.f.innermost_loop(i.place)
            for_good = not any(w > i.place for w in writes) and (loop is None or not any(loop[0] <= w for w in writes))
            for_now = (not any(i.place < w <= last for w in writes) and all(u.block == i.block for u in users) and
                       i.id not in self.named.values())
            if root in self.named or for_good or for_now:
                self.alias[i.id] = i.operands[0]

    def needs_mask(self, store):
        """False where no lane beyond the active ones holds a value there that anyone may still read."""
        root, path = self.path(store.operands[0])
        if root in self.parameters and root not in self.own:
            return True
        if root == self.returned and any(i.place < store.place for i in self.f.of('ReturnValue')):
            return True
        accesses = self.accesses(root)
        nests = [self.nest[place] for place, *_ in accesses] + [()] * (root in self.own)
        common = tuple(level[0] for level in itertools.takewhile(lambda level: len(set(level)) == 1, zip(*nests)))
        if self.nest[store.place] == common:
            first = accesses[0]
            if not any(n[0] == 'loop' for n in common) or (
                    first[1] and not first[2] and first[3].name == 'Store' and self.nest[first[0]] == common):
                return False
        overlaps = lambda other: path[:len(other)] == other or other[:len(path)] == path
        if root in self.own or any(writes and place < store.place and overlaps(other) for place, writes, other, _ in accesses):
            return True
        loop = self.f.innermost_loop(store.place)
        return loop is not None and not all(loop[0] <= place < loop[1] for place, *_ in accesses)
