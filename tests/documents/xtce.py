#!/usr/bin/env python3
"""Generates tumblesight.xtce.xml, the packets as an XTCE 1.2 database (OMG formal/18-10-04) for ground systems. The packages
have it beside the documents.

  tests/documents/xtce.py --write build/tumblesight.xtce.xml

It is valid by the schema of the OMG (SpaceSystem.xsd of XTCE 1.2): xmllint --noout --schema SpaceSystem.xsd tumblesight.xtce.xml

The fields come from where docs/icd.md has them (icd.py): the messages' structures, the headers' tables of bytes, the table of
telecommands. Values are raw, except that quaternions are calibrated.
"""
import argparse
import pathlib
import re
import xml.etree.ElementTree as ET

import icd

NAMESPACE = "http://www.omg.org/spec/XTCE/20180204"
ERROR_CONTROL = {"Polynomial": "1021", "InitRemainder": "FFFF", "FinalXOR": "0000"}
# By the end of a field's name.
UNITS = {"_ns": "ns", "_us": "us", "_urad": "urad", "_urad_s": "urad/s", "_rad_s": "rad/s", "_mm": "mm", "_um": "um", "_um_s": "um/s", "_bytes": "byte", "_ppm": "ppm"}


def add(parent, tag, text=None, **attributes):
    element = ET.SubElement(parent, tag, {key: str(value) for key, value in attributes.items()})
    element.text = text
    return element


def unit_of(name):
    found = [end for end in UNITS if name.endswith(end)]
    return UNITS[max(found, key=len)] if found else None


def encode_integer(element, bits, signed):
    return add(element, "IntegerDataEncoding", sizeInBits=bits, encoding="twosComplement" if signed else "unsigned")


class Types:
    """The set of parameter or argument types, each made at its first use. The names of all sets must differ: `prefix`."""

    def __init__(self, parent, kind, prefix=""):
        self.parent, self.kind, self.prefix, self.made = parent, kind, prefix, set()

    def new(self, name, element, **attributes):
        """The element of a new type; None if there is one of that name."""
        if name in self.made:
            return None
        self.made.add(name)
        return add(self.parent, element + self.kind + "Type", name=name, **attributes)

    def integer(self, bits, signed, unit=None):
        name = f"{self.prefix}{'i' if signed else 'u'}{bits}" + (f"_{unit.replace('/', '_')}" if unit else "")
        element = self.new(name, "Integer", signed=str(signed).lower(), sizeInBits=max(bits, 32) if bits <= 32 else 64)
        if element is not None:
            units = add(element, "UnitSet")
            if unit:
                add(units, "Unit", unit)
            encode_integer(element, bits, signed)
        return name

    def quaternion(self):
        element = self.new("q30", "Float", sizeInBits=64)
        if element is not None:
            add(element, "UnitSet")
            calibrator = add(add(encode_integer(element, 32, True), "DefaultCalibrator"), "PolynomialCalibrator")
            add(calibrator, "Term", coefficient=repr(2.0**-30), exponent=1)
        return "q30"

    def enumeration(self, enum, bits):
        name = self.prefix + enum
        element = self.new(name, "Enumerated")
        if element is not None:
            add(element, "UnitSet")
            encode_integer(element, bits, False)
            values = add(element, "EnumerationList")
            for label, value, comment in icd.enum(icd.enum_path(enum), enum):
                description = {"shortDescription": comment} if comment else {}
                add(values, "Enumeration", value=value, label=icd.upper(label), **description)
        return name

    def binary(self, name, size_bits):
        """`size_bits`: a number, or a function that describes a size that varies."""
        name = self.prefix + name
        element = self.new(name, "Binary")
        if element is not None:
            add(element, "UnitSet")
            size = add(add(element, "BinaryDataEncoding"), "SizeInBits")
            if isinstance(size_bits, int):
                add(size, "FixedValue", str(size_bits))
            else:
                size_bits(size)
        return name

    def array(self, element_type, count):
        name = f"{element_type}_x{count}"
        element = self.new(name, "Array", arrayTypeRef=element_type)
        if element is not None:
            dimension = add(add(element, "DimensionList"), "Dimension")
            add(add(dimension, "StartingIndex"), "FixedValue", "0")
            add(add(dimension, "EndingIndex"), "FixedValue", str(count - 1))
        return name

    def of_field(self, field):
        if field.bits == 8 and field.name == "bytes":
            return self.binary(f"bytes_x{field.count}", 8 * field.count)
        if field.enum:
            element = self.enumeration(field.enum, field.bits)
        elif field.name.startswith("q_"):
            element = self.quaternion()
        else:
            element = self.integer(field.bits, field.signed, unit_of(field.name))
        return self.array(element, field.count) if field.count else element


def add_parameter(parameters, name, kind, comment=""):
    add(parameters, "Parameter", name=name, parameterTypeRef=kind, **({"shortDescription": comment} if comment else {}))


def telemetry(system):
    meta = add(system, "TelemetryMetaData")
    types = Types(add(meta, "ParameterTypeSet"), "Parameter")
    parameters = add(meta, "ParameterSet")
    containers = add(meta, "ContainerSet")

    fields = icd.packet_fields(icd.ENCODER)
    content = [field.bits for field in fields].index(None)
    base = add(containers, "SequenceContainer", name="TelemetryPacket", abstract="true",
               shortDescription="CCSDS 133.0-B space packet with a CUC time (301.0-B): 4 bytes of seconds, 4 bytes of fractions")
    entries = add(base, "EntryList")
    for field in fields[:content]:
        if field.name == "time":
            kind = types.new("cuc_4_4", "AbsoluteTime", shortDescription="Epoch: that of the platform's clock")
            encoding = add(kind, "Encoding", units="seconds", scale=repr(2.0**-32))
            encode_integer(encoding, field.bits, False)
            kind = "cuc_4_4"
        else:
            kind = types.integer(field.bits, False)
        add_parameter(parameters, "packet_" + field.name.lower().removeprefix("packet_"), kind)
        add(entries, "ParameterRefEntry", parameterRef="packet_" + field.name.lower().removeprefix("packet_"))
    for field in fields[content + 1:]:
        add_parameter(parameters, "packet_" + field.name, types.integer(field.bits, False), "CRC-16/CCITT over everything before it")

    for topic, apid in icd.apids().items():
        message = icd.CARRIED[topic][1]
        container = add(containers, "SequenceContainer", name=message)
        encoding = add(container, "BinaryEncoding")
        bits = 8 * icd.packet_bytes(topic)
        crc = add(add(encoding, "ErrorDetectCorrect"), "CRC", width=16, bitsFromReference=bits - 16)
        for tag, value in ERROR_CONTROL.items():
            add(crc, tag, value)
        add(add(encoding, "SizeInBits"), "FixedValue", str(bits))
        entries = add(container, "EntryList")
        for field in icd.message_layout(topic):
            name = f"{message}_{field.name}"
            kind = types.of_field(field)
            add_parameter(parameters, name, kind, field.comment)
            add(entries, "ArrayParameterRefEntry" if field.count and not kind.startswith("bytes_") else "ParameterRefEntry", parameterRef=name)
        for field in fields[content + 1:]:
            add(entries, "ParameterRefEntry", parameterRef="packet_" + field.name)
        criteria = add(add(container, "BaseContainer", containerRef="TelemetryPacket"), "RestrictionCriteria")
        add(add(criteria, "ComparisonList"), "Comparison", parameterRef="packet_apid", value=apid)


def command_arguments(arguments):
    """[(name, bits, enumeration or None, whether it is data)] of a telecommand; bits: None for data up to the trailer."""
    found = []
    for argument in arguments:
        if argument.bits is None:
            found.append(("data", 8 * argument.most if argument.least == argument.most else None, None, True))
        else:
            name = (argument.enumeration or argument.name.replace("crc32", "crc_32")).lower()
            found.append((name, argument.bits, argument.enumeration, False))
    return found


def hex_of(value, bits):
    return f"{value:0{2 * ((bits + 7) // 8)}X}"


def commands(system):
    meta = add(system, "CommandMetaData")
    types = Types(add(meta, "ParameterTypeSet"), "Parameter", "command_")
    parameters = add(meta, "ParameterSet")
    argument_types = Types(add(meta, "ArgumentTypeSet"), "Argument", "argument_")
    meta_commands = add(meta, "MetaCommandSet")
    known = set()

    def entry(entries, field, constant=None):
        value = field.value if constant is None else constant
        name = "command_" + field.name.lower()
        if value is not None:
            add(entries, "FixedValueEntry", name=name, binaryValue=hex_of(value, field.bits), sizeInBits=field.bits)
            return
        if name not in known:
            known.add(name)
            add_parameter(parameters, name, types.integer(field.bits, False) if field.bits <= 64 else
                          types.binary(f"bytes_x{field.bits // 8}", field.bits))
        add(entries, "ParameterRefEntry", parameterRef=name)

    fields = icd.packet_fields(icd.COMMAND_PACKET)
    content = [field.bits for field in fields].index(None)
    length_at = [field.name for field in fields].index("data_length")
    header, before, trailer = fields[:length_at + 1], fields[length_at + 1:content], fields[content + 1:]

    base = add(meta_commands, "MetaCommand", name="Telecommand", abstract="true",
               shortDescription="CCSDS 133.0-B space packet; docs/icd.md says how checksum and trailer are computed")
    entries = add(add(base, "CommandContainer", name="TelecommandPacket"), "EntryList")
    for field in header:
        entry(entries, field)

    for code, name, _, _, rows, modes in icd.function_rows():
        arguments = command_arguments(rows)
        comment = ", ".join(row.text for row in rows)
        command = add(meta_commands, "MetaCommand", name=name, shortDescription="; ".join(filter(None, (comment, f"modes: {modes}"))))
        add(command, "BaseMetaCommand", metaCommandRef="Telecommand")
        if arguments:
            listed = add(command, "ArgumentList")
        container = add(command, "CommandContainer", name=name + "_packet")
        entries = add(container, "EntryList")
        for field in before:
            entry(entries, field, code if field.name == "function_code" else None)
        for argument, bits, enum, data in arguments:
            if enum and any(f"enum class {enum} :" in path.read_text() for path in (icd.ROOT / icd.MESSAGES).glob("*.hpp")):
                kind = argument_types.enumeration(enum, bits)
            elif bits is None:  # up to the trailer: what the packet's data length leaves
                others = sum(field.bits for field in before + trailer) + sum(other[1] or 0 for other in arguments)

                def size(element, others=others):
                    dynamic = add(element, "DynamicValue")
                    add(dynamic, "ParameterInstanceRef", parameterRef="command_data_length", useCalibratedValue="false")
                    add(dynamic, "LinearAdjustment", slope=8, intercept=8 - others)
                kind = argument_types.binary(f"{name}_{argument}", size)
            elif data:
                kind = argument_types.binary(f"bytes_x{bits // 8}", bits)
            else:
                kind = argument_types.integer(bits, False)
            add(listed, "Argument", name=argument, argumentTypeRef=kind)
            add(entries, "ArgumentRefEntry", argumentRef=argument)
        for field in trailer:
            entry(entries, field)
        add(container, "BaseContainer", containerRef="TelecommandPacket")


def document():
    system = ET.Element("SpaceSystem", {"xmlns": NAMESPACE, "name": "Tumblesight",
                                        "shortDescription": "Telemetry and telecommand packets; generated by tests/documents/xtce.py"})
    telemetry(system)
    commands(system)
    ET.indent(system)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(system, encoding="unicode") + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", type=pathlib.Path, metavar="FILE", required=True, help="where to write the database")
    path = parser.parse_args().write
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(document(), encoding="utf-8")


if __name__ == "__main__":
    main()
