"""The numbers that travel in place of names."""

import hashlib


def name_hash(name):
    """DDS-RPC, basic mapping: the first four bytes of the name's MD5, as a little-endian number."""
    return int.from_bytes(hashlib.md5(name.encode()).digest()[:4], "little")


def signature(text):
    """A 64-bit digest of an operation's canonical text."""
    return int.from_bytes(hashlib.md5(text.encode()).digest()[:8], "little")


def signed(number):
    """A 32-bit hash as an IDL `long`."""
    return number - (1 << 32) if number >= 1 << 31 else number
