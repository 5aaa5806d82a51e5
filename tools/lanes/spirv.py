"""Reads the SPIR-V that glslang makes of the kernel's language subset (src/shading/language.h): its types, constants
and functions, and where each function's control goes. An instruction beyond these is an error that names it."""
import struct

OPCODES = {0: 'Nop', 1: 'Undef', 5: 'Name', 6: 'MemberName', 8: 'Line', 11: 'ExtInstImport', 12: 'ExtInst', 19: 'TypeVoid',
           20: 'TypeBool', 21: 'TypeInt', 22: 'TypeFloat', 23: 'TypeVector', 24: 'TypeMatrix', 28: 'TypeArray', 30: 'TypeStruct',
           32: 'TypePointer', 33: 'TypeFunction', 41: 'ConstantTrue', 42: 'ConstantFalse', 43: 'Constant',
           44: 'ConstantComposite', 48: 'SpecConstantTrue', 49: 'SpecConstantFalse', 54: 'Function', 55: 'FunctionParameter',
           56: 'FunctionEnd', 57: 'FunctionCall', 59: 'Variable', 61: 'Load', 62: 'Store', 65: 'AccessChain',
           79: 'VectorShuffle', 80: 'CompositeConstruct', 81: 'CompositeExtract', 109: 'ConvertFToU', 112: 'ConvertUToF',
           124: 'Bitcast', 127: 'FNegate', 128: 'IAdd', 129: 'FAdd', 130: 'ISub', 131: 'FSub', 132: 'IMul', 133: 'FMul',
           134: 'UDiv', 136: 'FDiv', 137: 'UMod', 142: 'VectorTimesScalar', 148: 'Dot', 154: 'Any', 155: 'All',
           164: 'LogicalEqual', 165: 'LogicalNotEqual', 166: 'LogicalOr', 167: 'LogicalAnd', 168: 'LogicalNot',
           169: 'Select', 170: 'IEqual', 171: 'INotEqual', 172: 'UGreaterThan', 174: 'UGreaterThanEqual', 176: 'ULessThan',
           178: 'ULessThanEqual', 180: 'FOrdEqual', 183: 'FUnordNotEqual', 184: 'FOrdLessThan', 186: 'FOrdGreaterThan',
           188: 'FOrdLessThanEqual', 190: 'FOrdGreaterThanEqual', 194: 'ShiftRightLogical', 196: 'ShiftLeftLogical',
           197: 'BitwiseOr', 198: 'BitwiseXor', 199: 'BitwiseAnd', 200: 'Not', 204: 'BitReverse', 245: 'Phi', 246: 'LoopMerge',
           247: 'SelectionMerge', 248: 'Label', 249: 'Branch', 250: 'BranchConditional', 253: 'Return', 254: 'ReturnValue',
           255: 'Unreachable'}
# Source text, capabilities, entry points, execution modes and decorations say nothing about what functions compute.
IGNORED = {2, 3, 4, 7, 10, 14, 15, 16, 17, 71, 72, 330, 331}
WITHOUT_RESULT = {'Nop', 'Name', 'MemberName', 'Line', 'FunctionEnd', 'Store', 'LoopMerge', 'SelectionMerge', 'Branch',
                  'BranchConditional', 'Return', 'ReturnValue', 'Unreachable'}


class Instruction:
    def __init__(self, name, words):
        self.name, self.type, self.id = name, None, None
        self.place, self.block = None, None  # in its function
        if name.startswith('Type') or name in ('Label', 'ExtInstImport'):
            self.id, words = words[0], words[1:]
        elif name not in WITHOUT_RESULT:
            self.type, self.id, words = words[0], words[1], words[2:]
        self.operands = list(words)


class Function:
    def __init__(self, start, name):
        self.id, self.type, self.name = start.id, start.type, name
        self.parameters, self.body = [], []

    def index(self):
        """Where instructions stand, and who uses whom."""
        self.definition = {i.id: i for i in self.body if i.id}
        self.blocks, self.uses = {}, {}
        for place, i in enumerate(self.body):
            if i.name == 'Label':
                label = i.id
                self.blocks[label] = []
            else:
                self.blocks[label].append(i)
            i.place, i.block = place, label
            for o in i.operands:
                self.uses.setdefault(o, []).append(i)
        self.loops = [(self.definition[i.block].place, self.definition[i.operands[0]].place)
                      for i in self.body if i.name == 'LoopMerge']

    def of(self, name):
        return [i for i in self.body if i.name == name]

    def merge_of(self, label):
        return next((i for i in self.blocks[label] if i.name in ('SelectionMerge', 'LoopMerge')), None)

    def innermost_loop(self, place):
        """(first, end) of the loop around a place, or None."""
        return max([l for l in self.loops if l[0] <= place < l[1]], default=None)

    def path(self, module, pointer):
        """(variable, member indices) that a pointer names."""
        i = self.definition.get(pointer)
        if i is None or i.name == 'Variable':
            return pointer, ()
        root, first = self.path(module, i.operands[0])
        return root, first + tuple(module.constants[o] for o in i.operands[1:])

    def is_copy_for(self, variable, call):
        """True where a variable is stored once, right before `call`, and read by it alone."""
        if variable not in self.definition or self.definition[variable].name != 'Variable':
            return False
        users = self.uses[variable]
        return (len(users) == 2 and users[0].name == 'Store' and users[0].operands[0] == variable and
                users[1] is call and users[0].block == call.block)


def text_of(words):
    return struct.pack('<%dI' % len(words), *words).split(b'\0')[0].decode()


class Module:
    def __init__(self, data):
        words = struct.unpack('<%dI' % (len(data) // 4), data)
        if words[0] != 0x07230203:
            raise SystemExit('expected SPIR-V of this machine\'s byte order')
        self.names, self.member_names, self.types = {}, {}, {}
        self.constants, self.constant_text = {}, {}  # integers; C++ text of all
        self.functions, self.value_types = {}, {}
        function, at = None, 5
        while at < len(words):
            count, opcode = words[at] >> 16, words[at] & 0xffff
            if opcode not in IGNORED:
                if opcode not in OPCODES:
                    raise SystemExit('SPIR-V instruction %d in %s is not in the kernel\'s subset'
                                     % (opcode, function.name if function else 'the module'))
                i = Instruction(OPCODES[opcode], words[at + 1:at + count])
                if i.type:
                    self.value_types[i.id] = i.type
                function = self.add(i, function)
            at += count
        for f in self.functions.values():
            f.index()
        self.written = {}  # (function, parameter): it writes there
        for f in self.functions.values():
            for n in range(len(f.parameters)):
                self.find_written(f.id, n)
        self.find_taken()

    def add(self, i, function):
        if i.name == 'Name':
            self.names[i.operands[0]] = text_of(i.operands[1:])
        elif i.name == 'MemberName':
            self.member_names[i.operands[0], i.operands[1]] = text_of(i.operands[2:])
        elif i.name.startswith('Type'):
            self.types[i.id] = i
        elif 'Constant' in i.name:
            self.add_constant(i)
        elif i.name == 'Function':
            function = Function(i, self.names[i.id].split('(')[0])
            self.functions[i.id] = function
        elif i.name == 'FunctionEnd':
            function = None
        elif function is not None and i.name == 'FunctionParameter':
            function.parameters.append(i)
        elif function is not None and i.name not in ('Nop', 'Line'):
            function.body.append(i)
        return function

    def add_constant(self, i):
        type_ = self.types[i.type]
        if i.name == 'ConstantComposite':
            text = 'vec(%s)' % ', '.join(self.constant_text[o] for o in i.operands)
        elif type_.name == 'TypeBool':
            # The subset's one specialization constant (surface.h) is false unless asked for: the kernel has every model.
            text = 'true' if i.name in ('ConstantTrue', 'SpecConstantFalse', 'SpecConstantTrue') else 'false'
        elif type_.name == 'TypeFloat':
            text = struct.unpack('<f', struct.pack('<I', i.operands[0]))[0].hex() + 'f'
        else:
            self.constants[i.id] = i.operands[0]
            text = '%d%s' % (i.operands[0], '' if type_.operands[1] else 'u')
        self.constant_text[i.id] = text

    def is_pointer(self, value):
        type_ = self.value_types.get(value)
        return type_ is not None and self.types[type_].name == 'TypePointer'

    def find_written(self, function_id, n):
        """Whether a function writes through its pointer parameter `n`, itself or by those that it calls."""
        if (function_id, n) not in self.written:
            f = self.functions[function_id]
            parameter = f.parameters[n].id
            names = lambda pointer: self.is_pointer(pointer) and f.path(self, pointer)[0] == parameter
            self.written[function_id, n] = any(names(i.operands[0]) for i in f.of('Store')) or any(
                names(a) and self.find_written(i.operands[0], m)
                for i in f.of('FunctionCall') for m, a in enumerate(i.operands[1:]))
        return self.written[function_id, n]

    def find_taken(self):
        """Parameters that are their function's own to change: GLSL's plain ones, whose copies no caller reads again."""
        self.taken = {key for key, written in self.written.items() if written}
        for f in self.functions.values():
            for i in f.of('FunctionCall'):
                for n, a in enumerate(i.operands[1:]):
                    if not self.is_pointer(a) or not f.is_copy_for(a, i):
                        self.taken.discard((i.operands[0], n))
