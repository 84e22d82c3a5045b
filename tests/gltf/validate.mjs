// Checks glTF files with the Khronos validator: node validate.mjs FILE...
// Prints one line per file and one per error or warning; ends with 1 if there is any, with 2 without a file to check.
import {readFile} from 'node:fs/promises';
import {dirname, resolve} from 'node:path';
import {validateBytes} from 'gltf-validator';

const severities = ['error', 'warning', 'info', 'hint'];

async function check(file) {
  let bytes;
  try {
    bytes = await readFile(file);
  } catch (error) {
    console.error(`${file}: cannot be read: ${error.message}`);
    return false;
  }
  let report;
  try {
    report = await validateBytes(new Uint8Array(bytes), {
      uri: file,
      maxIssues: 100,
      externalResourceFunction: async uri =>
          new Uint8Array(await readFile(resolve(dirname(file), decodeURIComponent(uri)))),
    });
  } catch (error) {
    console.error(`${file}: not a glTF file: ${error.message ?? error}`);
    return false;
  }
  const {numErrors, numWarnings, numInfos, messages} = report.issues;
  console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos`);
  for (const {severity, code, message, pointer} of messages)
    if (severity <= 2) console.log(`  ${severities[severity]} ${code} at ${pointer ?? `the file's start`}: ${message}`);
  return numErrors === 0 && numWarnings === 0;
}

const files = process.argv.slice(2);
if (files.length === 0) {
  console.error('usage: node validate.mjs FILE...');
  process.exit(2);
}
let clean = true;
for (const file of files) clean = await check(file) && clean;
process.exit(clean ? 0 : 1);
