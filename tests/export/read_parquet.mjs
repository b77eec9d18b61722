// Reads every Parquet file of a folder with hyparquet and compares it with the CSV file of the same name.
// usage: node read_parquet.mjs PARQUET_FOLDER JSON_FOLDER
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { parquetMetadata, parquetReadObjects } from "hyparquet";

const [parquets, jsons] = process.argv.slice(2);
let files = 0, values = 0;
const plain = (value) => typeof value === "bigint" ? Number(value) : value ?? null;
for (const name of readdirSync(parquets).filter((each) => each.endsWith(".parquet"))) {
  const bytes = readFileSync(join(parquets, name));
  const file = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
  const expected = JSON.parse(readFileSync(join(jsons, name.replace(".parquet", ".json"))));
  const found = await parquetReadObjects({ file });
  if (found.length !== expected.length || Number(parquetMetadata(file).num_rows) !== expected.length)
    throw new Error(`${name}: ${found.length} rows, not ${expected.length}`);
  expected.forEach((row, k) => {
    for (const [column, value] of Object.entries(row)) {
      ++values;
      const other = plain(found[k][column]);
      if (other !== value && !(typeof value === "number" && Number(value) === other))
        throw new Error(`${name}, row ${k}, ${column}: ${other}, not ${value}`);
    }
  });
  ++files;
}
console.log(`${files} files, ${values} values, all alike`);
if (files < 20 || values < 1000) process.exit(1);
