"""Common Data Representation, written by its specification (OMG DDSI-RTPS 10)."""
import struct


class Cdr:
    def __init__(self, big_endian=False):
        self.order = ">" if big_endian else "<"
        self.bytes = bytearray()
        self.head = b"\0\0\0\0" if big_endian else b"\0\1\0\0"

    def number(self, code, value):
        size = struct.calcsize(code)
        self.bytes += bytes(-len(self.bytes) % size) + struct.pack(self.order + code, value)
        return self

    def string(self, text):
        encoded = text.encode() + b"\0"
        self.number("I", len(encoded))
        self.bytes += encoded
        return self

    def numbers(self, values, is_sequence=True):
        if is_sequence:
            self.number("I", len(values))
        for value in values:
            self.number("d", value)
        return self

    def header(self, seconds, nanoseconds, frame):
        return self.number("i", seconds).number("I", nanoseconds).string(frame)

    def message(self):
        return self.head + bytes(self.bytes)
