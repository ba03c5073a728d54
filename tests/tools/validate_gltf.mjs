// Runs the Khronos glTF validator on files: node validate_gltf.mjs FOLDER_WITH_NODE_MODULES FILE...
// Prints every error and warning as "FILE: SEVERITY CODE at POINTER: MESSAGE"; exit 1 when there is one.
import {readFile} from 'node:fs/promises';
import {createRequire} from 'node:module';
import {dirname, join, resolve} from 'node:path';

const [packages, ...files] = process.argv.slice(2);
const validator = createRequire(join(resolve(packages), 'package.json'))('gltf-validator');
let found = 0;
for (const file of files) {
  const report = await validator.validateBytes(new Uint8Array(await readFile(file)), {
    uri: file,
    maxIssues: 200,
    externalResourceFunction: async uri => new Uint8Array(await readFile(join(dirname(file), decodeURIComponent(uri)))),
  });
  for (const message of report.issues.messages)
    if (message.severity < 2) {
      ++found;
      console.log(`${file}: ${message.severity ? 'warning' : 'error'} ${message.code} at ${message.pointer}: ${message.message}`);
    }
}
process.exit(found > 0 ? 1 : 0);
