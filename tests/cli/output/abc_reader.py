"""Reader of Alembic archives in the form Ogawa, written from the description of the format. It raises
if a file violates the format."""

import struct

import numpy

IS_DATA = 1 << 63
TYPES = {0: "u1", 1: "u1", 6: "<i4", 7: "<u8", 10: "<f4", 11: "<f8"}
KEY_BYTES = 16  # in front of each sample


class Archive:
    def __init__(self, path):
        self.bytes = path.read_bytes()
        magic, state, version, root = struct.unpack_from(">5sBHQ", self.bytes)
        if (magic, state, version) != (b"Ogawa", 0xFF, 1):
            raise ValueError("not a complete archive")
        root = int.from_bytes(root.to_bytes(8, "big"), "little")
        format_version, library, top, meta, samplings, metas = self.group(root)
        if struct.unpack("<i", self.data(format_version)) != (0,):
            raise ValueError("another version of the format")
        if struct.unpack("<i", self.data(library)) < (10000,):
            raise ValueError("an older library")
        self.meta = self.data(meta).decode()
        self.metas = [""] + self.texts(self.data(metas))
        self.samplings = self.read_samplings(self.data(samplings))
        self.objects = self.children(top)

    def group(self, place):
        if place & IS_DATA:
            raise ValueError("data in place of a group")
        if place == 0:
            return []
        (count,) = struct.unpack_from("<Q", self.bytes, place)
        return list(struct.unpack_from(f"<{count}Q", self.bytes, place + 8))

    def data(self, place):
        if not place & IS_DATA:
            raise ValueError("a group in place of data")
        place ^= IS_DATA
        if place == 0:
            return b""
        (size,) = struct.unpack_from("<Q", self.bytes, place)
        if place + 8 + size > len(self.bytes):
            raise ValueError("data beyond the file")
        return self.bytes[place + 8:place + 8 + size]

    @staticmethod
    def texts(data):
        texts = []
        while data:
            texts.append(data[1:1 + data[0]].decode())
            data = data[1 + data[0]:]
        return texts

    @staticmethod
    def read_samplings(data):
        samplings, at = [], 0
        while at < len(data):
            most, cycle, count = struct.unpack_from("<IdI", data, at)
            times = struct.unpack_from(f"<{count}d", data, at + 16)
            samplings.append((most, cycle, times))
            at += 16 + 8 * count
        return samplings

    def children(self, place):
        """Returns the objects of a group by their names."""
        _, *groups, headers = self.group(place)
        data, objects = self.data(headers), {}
        for group in groups:
            (size,) = struct.unpack_from("<I", data)
            name, index = data[4:4 + size].decode(), data[4 + size]
            objects[name] = Object(self, group, self.metas[index])
            data = data[5 + size:]
        if len(data) != 32:
            raise ValueError("a list of objects ends with two hashes")
        return objects


class Object:
    def __init__(self, archive, place, meta):
        self.meta = dict(item.split("=", 1) for item in meta.split(";"))
        top, *_ = archive.group(place)
        compound, header = archive.group(top)
        info = self.headers(archive, archive.data(header))
        if [kind for kind, *_ in info] != [0]:
            raise ValueError("an object has one compound")
        self.compound = info[0][1]
        *groups, headers = archive.group(compound)
        self.properties = {}
        for group, (kind, name, *rest) in zip(groups, self.headers(archive, archive.data(headers)),
                                              strict=True):
            self.properties[name] = Property(archive, group, kind, *rest)
        self.objects = archive.children(place)

    @staticmethod
    def headers(archive, data):
        """Returns kind, name, and for properties type, extent, count, sampling, is_constant, meta."""
        found = []
        while data:
            (info,) = struct.unpack_from("<I", data)
            width = 1 << (info >> 2 & 3)
            numbers = (int.from_bytes(data[at:at + width], "little")
                       for at in range(4, len(data), width))
            kind, at = info & 3, 4
            count = sampling = 0
            if kind != 0:
                count, at = next(numbers), at + width
                if info & 0x200:
                    raise ValueError("repeated samples are not expected")
                if info & 0x100:
                    sampling, at = next(numbers), at + width
            size, at = next(numbers), at + width
            found.append((kind, data[at:at + size].decode(), info >> 4 & 15, info >> 12 & 255, count,
                          sampling, bool(info & 0x800), archive.metas[info >> 20 & 255]))
            data = data[at + size:]
        return found


class Property:
    """`samples` has one array per sample, or only the first one if they are equal."""

    def __init__(self, archive, group, kind, number, extent, count, sampling, is_constant, meta):
        children = archive.group(group)
        places = children[::2] if kind == 2 else children
        if kind == 2 and any(archive.data(size) for size in children[1::2]):
            raise ValueError("an array of one dimension has no list of dimensions")
        if len(places) != (1 if is_constant else count):
            raise ValueError("another number of samples")
        self.is_array, self.meta = kind == 2, meta
        self.times = archive.samplings[sampling][2]
        if sampling and count != len(self.times):
            raise ValueError("another number of times")
        self.samples = []
        for place in places:
            values = numpy.frombuffer(archive.data(place)[KEY_BYTES:], TYPES[number])
            self.samples.append(values.reshape(-1, extent) if extent > 1 else values)
