"""Tests of the XTCE database: its structure, and that the decoder refuses what it has to refuse."""
# Verifies TS-TLM-080.
import binascii
import unittest

import xtce
import xtce_decoder

XTCE = xtce_decoder.XTCE


class XtceStructure(unittest.TestCase):

    def setUp(self):
        self.database = xtce_decoder.Database(xtce.document())

    def test_every_reference_resolves_and_every_name_is_unique(self):
        root = self.database.root
        arguments = {one.get("name") for one in root.iter(XTCE + "Argument")}
        commands = {one.get("name") for one in root.iter(XTCE + "MetaCommand")}
        known = {"parameterTypeRef": self.database.types, "argumentTypeRef": self.database.types, "arrayTypeRef": self.database.types,
                 "parameterRef": self.database.parameters, "argumentRef": arguments, "containerRef": self.database.containers,
                 "metaCommandRef": commands}
        references = [(key, value) for element in root.iter() for key, value in element.attrib.items() if key in known]
        self.assertGreater(len(references), 100)
        for key, value in references:
            self.assertIn(value, known[key], key)
        for tags in (("SequenceContainer", "CommandContainer"), ("MetaCommand",), ("Parameter",)):
            names = [one.get("name") for tag in tags for one in root.iter(XTCE + tag)]
            self.assertEqual(len(names), len(set(names)), tags)
        types = [one.get("name") for one in root.iter() if one.tag.endswith(("ParameterType", "ArgumentType"))]
        self.assertEqual(len(types), len(set(types)))

    def test_no_parameter_or_type_is_unused(self):
        root = self.database.root
        used = {value for element in root.iter() for key, value in element.attrib.items() if key.endswith("Ref")}
        self.assertEqual(set(self.database.parameters) - used, set())
        self.assertEqual(set(self.database.types) - used, set())

    def test_entries_sum_up_to_the_length_of_the_packet(self):
        for name, container in self.database.containers.items():
            if container.find(XTCE + "BinaryEncoding") is not None:
                bits = self.database.size_bits(container.find(XTCE + "BinaryEncoding"), {})
                values = {}
                left = xtce_decoder.Bits(bytes(bits // 8))
                base = self.database.containers[container.find(XTCE + "BaseContainer").get("containerRef")]
                for one in (base, container):
                    for entry in one.find(XTCE + "EntryList"):
                        parameter = entry.get("parameterRef")
                        values[parameter] = self.database.value(self.database.parameters[parameter], left, values)
                self.assertEqual(left.left, 0, name)
                covered = next(container.iter(XTCE + "CRC")).get("bitsFromReference")
                self.assertEqual(int(covered), bits - 16, name)

    def test_enumerations_have_distinct_values_that_fit(self):
        for kind in self.database.types.values():
            values = [int(one.get("value")) for one in kind.iter(XTCE + "Enumeration")]
            self.assertEqual(len(values), len(set(values)))
            if values:
                self.assertLess(max(values), 2 ** int(kind.find(XTCE + "IntegerDataEncoding").get("sizeInBits")))


class XtceDecoder(unittest.TestCase):

    def setUp(self):
        self.database = xtce_decoder.Database(xtce.document())
        # An event packet, laid out by hand from docs/icd.md: 2.5 s, id 53, severity 2, arguments 6, -1, 0.
        body = bytes.fromhex("09F3 C007 0020" "00000002 80000000" "00000000 9502F900" "0035 02" "00000006 FFFFFFFF 00000000")
        self.packet = body + binascii.crc_hqx(body, 0xFFFF).to_bytes(2, "big")

    def test_decodes_a_packet_made_by_hand(self):
        name, values = self.database.telemetry(self.packet)
        self.assertEqual(name, "Event")
        self.assertEqual(values["packet_sequence_count"], 7)
        self.assertEqual(values["packet_time"], 5 << 31)
        self.assertEqual(values["Event_time_ns"], 2_500_000_000)
        self.assertEqual((values["Event_id"], values["Event_severity"], values["Event_arguments"]), (53, 2, [6, -1, 0]))
        calibrated = {name: self.database.calibrated(self.database.parameters[name], value) for name, value in values.items()}
        self.assertEqual((calibrated["packet_time"], calibrated["Event_id"], calibrated["Event_severity"]), (2.5, "SAFE_ENTERED", "ERROR"))

    def test_any_changed_bit_is_noticed(self):
        for bit in range(8 * len(self.packet)):
            damaged = bytearray(self.packet)
            damaged[bit // 8] ^= 0x80 >> bit % 8
            with self.assertRaises(ValueError, msg=f"bit {bit}"):
                self.database.telemetry(bytes(damaged))

    def test_a_packet_of_another_length_is_refused(self):
        for packet in (self.packet[:-1], self.packet + b"\0"):
            with self.assertRaises(ValueError):
                self.database.telemetry(packet)

    def test_a_file_that_ends_within_a_packet_is_refused(self):
        self.assertEqual(list(xtce_decoder.packets(2 * self.packet)), [self.packet, self.packet])
        with self.assertRaises(ValueError):
            list(xtce_decoder.packets(self.packet[:-1]))


if __name__ == "__main__":
    unittest.main()
