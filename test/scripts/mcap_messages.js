// SPDX-License-Identifier: BSD-3-Clause
// Reads an MCAP file with @mcap/core, the reader of Foxglove's programs, found by NODE_PATH.
//
// usage: node mcap_messages.js FILE
// Prints as JSON: {topic: [schema, number of messages, first time, last time, [first message, last message]]}.
"use strict";

const { readFileSync } = require("node:fs");
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");

const file = readFileSync(process.argv[2]);
const readable = {
    size: async () => BigInt(file.length),
    read: async (offset, size) => new Uint8Array(file.subarray(Number(offset), Number(offset + size))),
};

/// By its index, as a player does.
async function messagesByIndex() {
    const reader = await McapIndexedReader.Initialize({ readable });
    const topics = {};
    let time = 0n, count = 0n;
    for await (const message of reader.readMessages()) {
        if (message.logTime < time) throw new Error("messages are not in order of time");
        time = message.logTime;
        ++count;
        const { topic, schemaId, messageEncoding } = reader.channelsById.get(message.channelId);
        const { name, encoding } = reader.schemasById.get(schemaId);
        if (messageEncoding !== "json" || encoding !== "jsonschema") throw new Error(`${topic} is not JSON`);
        const content = JSON.parse(new TextDecoder().decode(message.data));
        topics[topic] ??= [name, 0, Number(time) / 1e9, 0, [content]];
        topics[topic][1] += 1;
        topics[topic][3] = Number(time) / 1e9;
        topics[topic][4][1] = content;
    }
    if (count !== reader.statistics.messageCount) throw new Error("the index does not find every message");
    return topics;
}

/// From the first byte to the last, with all checksums.
function checkStream() {
    const reader = new McapStreamReader({ validateCrcs: true });
    reader.append(file);
    while (reader.nextRecord() !== undefined);
    if (!reader.done()) throw new Error("the file ends early");
}

checkStream();
messagesByIndex().then((topics) => console.log(JSON.stringify(topics)));
