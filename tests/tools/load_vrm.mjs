// Loads a VRM avatar as a viewer does, with three.js and @pixiv/three-vrm: node load_vrm.mjs FOLDER_WITH_NODE_MODULES FILE
// Prints {"version", "name", "bones", "expressions", "moved"} as JSON; `moved`: for each expression at 1, how many morph targets and
// what their weights sum to. Images are not decoded.
import {readFileSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';

const [packages, file] = process.argv.slice(2);
const from = name => import(pathToFileURL(join(resolve(packages), 'node_modules', name)).href);

// What three.js asks of a browser when a file has images.
globalThis.self = globalThis.window = globalThis;
globalThis.document = {
  createElementNS() {
    const listeners = {};
    return {
      style: {},
      addEventListener: (type, listener) => (listeners[type] = listener),
      removeEventListener: () => {},
      set src(_) { setTimeout(() => listeners.load?.call(this), 0); },
    };
  },
};

const {GLTFLoader} = await from('three/examples/jsm/loaders/GLTFLoader.js');
const {VRMLoaderPlugin} = await from('@pixiv/three-vrm/lib/three-vrm.module.js');
const loader = new GLTFLoader();
loader.register(parser => new VRMLoaderPlugin(parser));
const bytes = readFileSync(file);
const gltf = await loader.parseAsync(bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length), '');
const vrm = gltf.userData.vrm;

function moved(name) {
  vrm.expressionManager.setValue(name, 1);
  vrm.update(1 / 60);
  const weights = [];
  vrm.scene.traverse(object => weights.push(...(object.morphTargetInfluences ?? [])));
  vrm.expressionManager.setValue(name, 0);
  return {count: weights.filter(w => w !== 0).length, sum: weights.reduce((sum, w) => sum + w, 0)};
}

const names = vrm.expressionManager.expressions.map(e => e.expressionName).sort();
console.log(JSON.stringify({
  version: vrm.meta.metaVersion,
  name: vrm.meta.name,
  bones: Object.keys(vrm.humanoid.humanBones).sort(),
  expressions: names,
  moved: Object.fromEntries(names.map(name => [name, moved(name)])),
}));
process.exit(0);
