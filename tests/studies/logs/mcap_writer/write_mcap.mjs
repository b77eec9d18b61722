// Writes an MCAP file from a description: node write_mcap.mjs DESCRIPTION.json FILE.mcap
// {"compression": "none" | "lz4" | "zstd" | "no chunks", "schemas": [{name, encoding, text}],
//  "channels": [{schema (from 0, -1: none), topic, encoding}], "messages": [{channel, log_time_ns, data (base64)}]}
import { execFileSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { McapWriter } from "@mcap/core";

const description = JSON.parse(readFileSync(process.argv[2], "utf8"));
const pieces = [];
let size = 0;
const writable = {
    async write(bytes) {
        pieces.push(Buffer.from(bytes));
        size += bytes.length;
    },
    position: () => BigInt(size),
};
const options = { writable, chunkSize: 16384, useChunks: description.compression !== "no chunks" };
if (description.compression === "lz4" || description.compression === "zstd") {
    options.compressChunk = (data) => ({
        compression: description.compression,
        compressedData: execFileSync(description.compression, ["-c", "-q"], { input: data, maxBuffer: 1 << 28 }),
    });
}
const writer = new McapWriter(options);
await writer.start({ profile: "", library: "capstan tests" });
const schemas = [];
for (const { name, encoding, text } of description.schemas)
    schemas.push(await writer.registerSchema({ name, encoding, data: new TextEncoder().encode(text) }));
const channels = [];
for (const { schema, topic, encoding } of description.channels)
    channels.push(await writer.registerChannel({
        topic, messageEncoding: encoding, schemaId: schema < 0 ? 0 : schemas[schema], metadata: new Map(),
    }));
let sequence = 0;
for (const { channel, log_time_ns, data } of description.messages)
    await writer.addMessage({
        channelId: channels[channel], sequence: sequence++, logTime: BigInt(log_time_ns), publishTime: BigInt(log_time_ns),
        data: Buffer.from(data, "base64"),
    });
await writer.end();
writeFileSync(process.argv[3], Buffer.concat(pieces));
