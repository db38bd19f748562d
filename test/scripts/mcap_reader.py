#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Reads an MCAP file by its specification and checks what a reader relies on: magic bytes, lengths, checksums, the
order of messages, that the index finds each of them, that messages are as their schema says.

usage: mcap_reader.py FILE
Prints as JSON: {topic: [schema, number of messages, first time, last time]}.
"""

import base64
import json
import struct
import sys
import zlib

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = 1, 2, 3, 4, 5, 6, 7, 8
STATISTICS, SUMMARY_OFFSET, DATA_END = 11, 14, 15
KINDS = {"object": dict, "array": list, "string": str, "number": (int, float), "integer": int, "boolean": bool}


class Fields:
    def __init__(self, data):
        self.data, self.at = data, 0

    def number(self, kind):
        value, = struct.unpack_from("<" + kind, self.data, self.at)
        self.at += struct.calcsize(kind)
        return value

    def block(self, kind="I"):
        size = self.number(kind)
        assert self.at + size <= len(self.data), "a length beyond the record"
        self.at += size
        return self.data[self.at - size:self.at]

    def text(self):
        return self.block().decode()

    def table(self, kinds):
        return [row for row in struct.iter_unpack("<" + kinds, self.block())]


def records(data, start, end):
    """(opcode, position, content) of each record."""
    while start < end:
        opcode, size = struct.unpack_from("<BQ", data, start)
        assert start + 9 + size <= end, f"a record at {start} ends too late"
        yield opcode, start, data[start + 9:start + 9 + size]
        start += 9 + size
    assert start == end


def check_schema(schema):
    """Readers find the fields of messages in the schema before they read any."""
    assert schema["type"] in KINDS, f"a schema of type {schema['type']}"
    if schema["type"] == "object":
        assert isinstance(schema["properties"], dict), "a schema of an object without properties"
        for part in schema["properties"].values():
            check_schema(part)
    if schema["type"] == "array":
        check_schema(schema["items"])


def conforms(value, schema):
    if not isinstance(value, KINDS[schema["type"]]):
        return value is None and schema["type"] == "number"
    if schema["type"] == "object":
        properties = schema["properties"]
        return value.keys() == properties.keys() and all(conforms(value[key], properties[key]) for key in value)
    if schema["type"] == "array":
        return all(conforms(item, schema["items"]) for item in value)
    return schema.get("contentEncoding") != "base64" or bool(base64.b64decode(value, validate=True))


def message_in(content):
    fields = Fields(content)
    channel, _, time, published = (fields.number(kind) for kind in "HIQQ")
    assert time == published
    return channel, time, json.loads(content[fields.at:])


def read(data):
    assert data.startswith(MAGIC) and data.endswith(MAGIC), "magic bytes"
    footer_at = len(data) - len(MAGIC) - 9 - 20
    (opcode, _, footer), = records(data, footer_at, len(data) - len(MAGIC))
    summary, offsets, checksum = struct.unpack("<QQI", footer)
    assert opcode == FOOTER and zlib.crc32(data[summary:-len(MAGIC) - 4]) == checksum, "checksum of the summary"

    schemas, channels, messages, index, inside = {}, {}, [], {}, {}
    for opcode, at, content in records(data, len(MAGIC), summary):
        fields = Fields(content)
        if opcode == SCHEMA:
            number, name, encoding = fields.number("H"), fields.text(), fields.text()
            assert number > 0 and encoding == "jsonschema"
            schemas[number] = name, json.loads(fields.block())
            check_schema(schemas[number][1])
        elif opcode == CHANNEL:
            number, schema, topic, encoding = fields.number("H"), fields.number("H"), fields.text(), fields.text()
            assert encoding == "json" and schema in schemas
            channels[number] = topic, schema
        elif opcode == CHUNK:
            first, last, size, checksum = (fields.number(kind) for kind in "QQQI")
            assert fields.text() == ""
            chunk, chunk_at = fields.block("Q"), at
            assert len(chunk) == size and zlib.crc32(chunk) == checksum, "checksum of a chunk"
            inside = {position: message_in(m) for op, position, m in records(chunk, 0, size) if op == MESSAGE}
            assert [min(m[1] for m in inside.values()), max(m[1] for m in inside.values())] == [first, last]
            messages += inside.values()
            index[chunk_at] = [first, last, {}]
        elif opcode == MESSAGE_INDEX:
            channel = fields.number("H")
            for time, position in fields.table("QQ"):
                assert inside[position][:2] == (channel, time), "the index of a message"
                del inside[position]
            index[chunk_at][2][channel] = at
        elif opcode == DATA_END:
            assert zlib.crc32(data[:at]) == fields.number("I"), "checksum of the data"
            assert not inside, "messages without index"
        else:
            assert opcode == HEADER

    groups = {}
    for opcode, at, content in records(data, summary, footer_at):
        fields = Fields(content)
        if opcode == SUMMARY_OFFSET:
            assert at >= offsets
            group, start, size = (fields.number(kind) for kind in "BQQ")
            assert {op for op, _, _ in records(data, start, start + size)} == {group}, "a summary offset"
            assert groups.pop(group) == start
        else:
            groups.setdefault(opcode, at)
        if opcode == CHUNK_INDEX:
            first, last, start, size = (fields.number(kind) for kind in "QQQQ")
            assert [first, last, dict(fields.table("HQ"))] == index.pop(start), "the index of a chunk"
            assert data[start] == CHUNK and struct.unpack_from("<Q", data, start + 1)[0] + 9 == size
        elif opcode == STATISTICS:
            assert fields.number("Q") == len(messages) and fields.number("H") == len(schemas)
            assert fields.number("I") == len(channels)
    assert not groups and not index, "not all is in the summary"

    times = [time for _, time, _ in messages]
    assert times == sorted(times), "messages in order of time"
    result = {}
    for channel, time, content in messages:
        topic, schema = channels[channel]
        assert conforms(content, schemas[schema][1]), f"a message of {topic} is not as its schema says"
        entry = result.setdefault(topic, [schemas[schema][0], 0, time / 1e9, 0])
        entry[1] += 1
        entry[3] = time / 1e9
    return result


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with open(sys.argv[1], "rb") as file:
        print(json.dumps(read(file.read())))
