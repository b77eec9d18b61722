// Prints an MCAP file as JSON, read by its index as viewers do: node read_mcap.mjs FILE.mcap
import { readFileSync } from "node:fs";
import { McapIndexedReader } from "@mcap/core";

const bytes = readFileSync(process.argv[2]);
const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, length) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + length))),
};
const reader = await McapIndexedReader.Initialize({ readable });
const topics = {};
for (const channel of reader.channelsById.values())
    topics[channel.topic] = {
        unit: channel.metadata.get("unit"), schema: reader.schemasById.get(channel.schemaId).name, encoding: channel.messageEncoding,
        counted: Number(reader.statistics.channelMessageCounts.get(channel.id)), time_ns: [], value: [],
    };
for await (const message of reader.readMessages({ validateCrcs: true })) {
    const topic = topics[reader.channelsById.get(message.channelId).topic];
    topic.time_ns.push(Number(message.logTime));
    topic.value.push(new DataView(message.data.buffer, message.data.byteOffset).getFloat64(4, true));
}
console.log(JSON.stringify({
    topics, chunks: reader.chunkIndexes.length, profile: reader.header.profile,
    messages: Number(reader.statistics.messageCount), first_ns: Number(reader.statistics.messageStartTime), last_ns: Number(reader.statistics.messageEndTime),
}));
