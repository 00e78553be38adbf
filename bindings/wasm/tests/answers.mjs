// SPDX-License-Identifier: Apache-2.0
//
// Answers to the cases that same_bytes.py has put into a folder: what answer.mjs runs in node and
// answer_chromium.mjs in a browser.

export class Answers {
  /** read(name): an ArrayBuffer of what is in that file of the folder, or a promise of it. */
  constructor(pierce, read) {
    this.pierce = pierce;
    this.read = read;
    this.scenes = new Map();
  }

  async sceneOf(stem) {
    if (!this.scenes.has(stem)) {
      const Type = stem.endsWith("f8") ? Float64Array : Float32Array;
      const numbers = async (part, Kind) => new Kind(await this.read(`${stem}.${part}`));
      const scene = this.pierce.scene(await numbers("vertices", Type), await numbers("triangles", Uint32Array));
      this.scenes.set(stem, { scene, rays: await numbers("rays", Type), points: await numbers("points", Type) });
    }
    return this.scenes.get(stem);
  }

  /** Columns by name. */
  async answer({ stem, words }) {
    const { scene, rays, points } = await this.sceneOf(stem);
    const openMesh = words.includes("--open-mesh");
    if (words[0] === "locate") return { "": scene.locate(points, { openMesh }) };
    if (words.includes("--signed")) return { "": scene.signedDistances(points, { openMesh }) };
    if (words[0] === "nearest") return scene.nearestPoints(points);
    switch (words[2]) {
      case "closest":
        return scene.closestHits(rays, { sides: words.includes("front") ? "front" : "both" });
      case "all":
        return scene.allHits(rays);
      case "crossings":
        return scene.crossings(rays);
      case "count":
        return { "": scene.countHits(rays) };
      default:
        return { "": scene.anyHits(rays) };
    }
  }
}
