"""Edge-case values of fields: extremes, NaN, empty, long, other scripts."""

import random
import struct

INTEGERS = {
    "int8": (-(2**7), 2**7 - 1),
    "uint8": (0, 2**8 - 1),
    "int16": (-(2**15), 2**15 - 1),
    "uint16": (0, 2**16 - 1),
    "int32": (-(2**31), 2**31 - 1),
    "uint32": (0, 2**32 - 1),
    "int64": (-(2**63), 2**63 - 1),
    "uint64": (0, 2**64 - 1),
}
NUMBERS = [0.0, -0.0, 1.0, -1.5, float("inf"), float("-inf"), float("nan")]
DOUBLES = [5e-324, 1.7976931348623157e308, -2.2250738585072014e-308, 0.1]
SINGLES = [1.401298464324817e-45, 3.4028234663852886e38, -1.1754943508222875e-38]
TEXTS = ["", "a", "map", "  ", "seven b", "eight by", 'quo"te\\\n\t', "Θεσσαλονίκη", "カメラ", "🤖🦾", "x" * 300]


class RandomValues:
    """A stream of values that a seed determines."""

    def __init__(self, seed):
        self.random = random.Random(seed)

    def boolean(self):
        return self.random.random() < 0.5

    def integer(self, kind):
        least, most = INTEGERS[kind]
        choice = self.random.randrange(6)
        return least if choice == 0 else most if choice == 1 else self.random.randint(least, most)

    def double(self):
        if self.random.random() < 0.3:
            return self.random.choice(NUMBERS + DOUBLES)
        return self.random.gauss(0, 10 ** self.random.randint(-3, 6))

    def single(self):
        if self.random.random() < 0.3:
            return self.random.choice(NUMBERS + SINGLES)
        # What a field of 32 bits keeps.
        return struct.unpack("f", struct.pack("f", self.random.gauss(0, 1000)))[0]

    def text(self):
        if self.random.random() < 0.7:
            return self.random.choice(TEXTS)
        return "".join(self.random.choice("abcdefg /_ß") for _ in range(self.random.randrange(40)))

    def length(self, depth, of_numbers):
        """Of an array without a fixed one."""
        if of_numbers and self.random.random() < 0.1:
            return self.random.randrange(1000, 3000)
        return self.random.choice([0, 1, 2, 3, 5, 8] if depth < 2 else [0, 0, 1, 2, 3])
