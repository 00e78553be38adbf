// SPDX-License-Identifier: Apache-2.0
//
// One file, dist/index.html, with all that the page needs in it: it opens from a folder, where a
// browser loads neither modules nor fetches anything.
import { fileURLToPath } from "node:url";
import { type Plugin, defineConfig } from "vite";

// Of KaTeX's fonts, those that the page uses, in the one format that every browser reads.
const fonts: Plugin = {
  name: "fonts",
  enforce: "pre",
  transform(code, id) {
    if (!id.includes("katex.min.css")) return null;
    return code
      .replace(/,url\([^)]*\.(woff|ttf)\) format\("(woff|truetype)"\)/g, "")
      .replace(/@font-face\{[^}]*KaTeX_(Caligraphic|Fraktur|SansSerif|Script|Typewriter)[^}]*\}/g, "")
      .replace(/@font-face\{[^}]*KaTeX_(Main|Math)-(Bold)?Italic[^}]*\}/g, (face) =>
        face.includes("Math-Italic") ? face : "");
  },
};

const oneFile: Plugin = {
  name: "one-file",
  enforce: "post",
  generateBundle(_, bundle) {
    const page = bundle["index.html"];
    if (page?.type !== "asset") return;
    let html = String(page.source);
    for (const [name, part] of Object.entries(bundle)) {
      if (part.type === "chunk") {
        const script = `<script>${part.code.replace(/<\/script/g, "<\\/script")}</script>`;
        html = html.replace(/<script type="module"[^>]*><\/script>/, "");
        html = html.replace("</body>", () => `${script}</body>`);
      } else if (name.endsWith(".css")) {
        const style = `<style>${part.source}</style>`;
        html = html.replace(/<link rel="stylesheet"[^>]*>/, () => style);
      } else {
        continue;
      }
      delete bundle[name];
    }
    page.source = html;
  },
};

export default defineConfig({
  base: "./",
  plugins: [fonts, oneFile],
  resolve: {
    alias: {
      "pierce-wasm": fileURLToPath(
        new URL("../bindings/wasm/package/src/index.ts", import.meta.url)),
    },
  },
  build: {
    target: "es2022",
    assetsInlineLimit: 1 << 24,
    cssCodeSplit: false,
    modulePreload: false,
    rollupOptions: { output: { format: "iife", inlineDynamicImports: true } },
    chunkSizeWarningLimit: 4096,
  },
});
