"""Decodes packets by an XTCE 1.2 database and nothing else: no file of this project but the database is read. It knows the part
of XTCE that xtce.py uses and raises an error for anything else, so that nothing is skipped silently.

  xtce_decoder.py DATABASE FILE   prints the packets of a file, one line of JSON each
"""
import binascii
import json
import sys
import xml.etree.ElementTree as ET

XTCE = "{http://www.omg.org/spec/XTCE/20180204}"


def tag(element):
    assert element.tag.startswith(XTCE), element.tag
    return element.tag.removeprefix(XTCE)


def child(element, *path):
    for name in path:
        element = element if element is None else element.find(XTCE + name)
    return element


class Bits:
    """A reader of big-endian bit fields."""

    def __init__(self, data):
        self.number, self.left = int.from_bytes(data, "big"), 8 * len(data)

    def take(self, bits):
        if bits > self.left:
            raise ValueError(f"the packet ends {bits - self.left} bits too early")
        self.left -= bits
        value = self.number >> self.left
        self.number &= (1 << self.left) - 1
        return value


class Database:
    def __init__(self, document):
        self.root = ET.fromstring(document.encode())
        self.types = {kind.get("name"): kind for section in ("ParameterTypeSet", "ArgumentTypeSet") for set_ in self.root.iter(XTCE + section)
                      for kind in set_}
        self.parameters = {one.get("name"): one.get("parameterTypeRef") for one in self.root.iter(XTCE + "Parameter")}
        self.containers = {one.get("name"): one for name in ("SequenceContainer", "CommandContainer") for one in self.root.iter(XTCE + name)}
        self.commands = {one.get("name"): one for one in self.root.iter(XTCE + "MetaCommand") if one.get("abstract") != "true"}

    def size_bits(self, element, values):
        fixed, dynamic = child(element, "SizeInBits", "FixedValue"), child(element, "SizeInBits", "DynamicValue")
        if fixed is not None:
            return int(fixed.text)
        adjust = child(dynamic, "LinearAdjustment")
        return round(values[child(dynamic, "ParameterInstanceRef").get("parameterRef")] * float(adjust.get("slope")) +
                     float(adjust.get("intercept")))

    def value(self, type_name, bits, values):
        """The raw value: an integer, a list, or the hexadecimal digits of bytes."""
        kind = self.types[type_name]
        if tag(kind).startswith("Array"):
            dimension = child(kind, "DimensionList", "Dimension")
            first, last = (int(child(dimension, end, "FixedValue").text) for end in ("StartingIndex", "EndingIndex"))
            return [self.value(kind.get("arrayTypeRef"), bits, values) for _ in range(first, last + 1)]
        encoding = child(kind, "BinaryDataEncoding")
        if encoding is not None:
            size = self.size_bits(encoding, values)
            return f"{bits.take(size):0{size // 4}x}"
        encoding = next(kind.iter(XTCE + "IntegerDataEncoding"))
        if encoding.get("byteOrder", "mostSignificantByteFirst") != "mostSignificantByteFirst":
            raise ValueError(f"{type_name}: byte order")
        size = int(encoding.get("sizeInBits"))
        raw = bits.take(size)
        signed = {"unsigned": False, "twosComplement": True}[encoding.get("encoding")]
        return raw - (1 << size) if signed and raw >> (size - 1) else raw

    def calibrated(self, type_name, raw):
        """The value with the type's labels, polynomial or scale applied."""
        kind = self.types[type_name]
        if tag(kind).startswith("Array"):
            return [self.calibrated(kind.get("arrayTypeRef"), one) for one in raw]
        if tag(kind).startswith("Enumerated"):
            labels = {int(one.get("value")): one.get("label") for one in kind.iter(XTCE + "Enumeration")}
            return labels.get(raw, raw)
        terms = list(kind.iter(XTCE + "Term"))
        if terms:
            return sum(float(term.get("coefficient")) * raw ** int(term.get("exponent")) for term in terms)
        scale = child(kind, "Encoding")
        return raw if scale is None else raw * float(scale.get("scale"))

    def read(self, container, bits, values, arguments=None):
        """Reads the entries of a container, those of its base first. False: the packet is of another kind."""
        base = child(container, "BaseContainer")
        if base is not None:
            if not self.read(self.containers[base.get("containerRef")], bits, values, arguments):
                return False
            for comparison in base.iter(XTCE + "Comparison"):
                if values[comparison.get("parameterRef")] != int(comparison.get("value")):
                    return False
        for entry in child(container, "EntryList"):
            kind = tag(entry)
            if kind in ("ParameterRefEntry", "ArrayParameterRefEntry"):
                name = entry.get("parameterRef")
                values[name] = self.value(self.parameters[name], bits, values)
            elif kind == "ArgumentRefEntry":
                name = entry.get("argumentRef")
                values[name] = self.value(arguments[name], bits, values)
            elif kind == "FixedValueEntry":
                if bits.take(int(entry.get("sizeInBits"))) != int(entry.get("binaryValue"), 16):
                    return False
            else:
                raise ValueError(f"{container.get('name')}: {kind}")
        return True

    def check_crc(self, container, packet):
        crc = next(container.iter(XTCE + "CRC"))
        if (child(crc, "Polynomial").text, child(crc, "FinalXOR").text, crc.get("width")) != ("1021", "0000", "16"):
            raise ValueError("only CRC-16/CCITT is known")
        covered = int(crc.get("bitsFromReference")) // 8
        found = binascii.crc_hqx(packet[:covered], int(child(crc, "InitRemainder").text, 16))
        if found != int.from_bytes(packet[covered:covered + 2], "big"):
            raise ValueError("wrong CRC")

    def telemetry(self, packet):
        """(name of the container, {parameter: raw value}) of a telemetry packet."""
        for name, container in self.containers.items():
            bits, values = Bits(packet), {}
            if tag(container) != "SequenceContainer" or container.get("abstract") == "true" or not self.read(container, bits, values):
                continue
            if bits.left or self.size_bits(child(container, "BinaryEncoding"), values) != 8 * len(packet):
                raise ValueError(f"{name}: the container has another length than the packet")
            self.check_crc(container, packet)
            return name, values
        raise ValueError("no container fits")

    def command(self, packet):
        """(name of the command, {parameter or argument: raw value}) of a telecommand packet."""
        for name, command in self.commands.items():
            bits, values = Bits(packet), {}
            arguments = {one.get("name"): one.get("argumentTypeRef") for one in command.iter(XTCE + "Argument")}
            if self.read(child(command, "CommandContainer"), bits, values, arguments):
                if bits.left:
                    raise ValueError(f"{name}: {bits.left} bits are left")
                return name, values
        raise ValueError("no command fits")


def packets(data):
    """The space packets of a file, cut by their own lengths."""
    while data:
        size = 7 + int.from_bytes(data[4:6], "big")
        if len(data) < size:
            raise ValueError("the file ends within a packet")
        yield data[:size]
        data = data[size:]


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        database = Database(file.read())
    with open(sys.argv[2], "rb") as file:
        for packet in packets(file.read()):
            name, values = database.telemetry(packet)
            print(json.dumps({"packet": name, **{key: database.calibrated(database.parameters[key], raw) for key, raw in values.items()}}))


if __name__ == "__main__":
    main()
