// What the page in one file holds: gzipped, in base64. Of a page that is served there is nothing.

export async function packed(name) {
  const text = globalThis[name];
  if (text === undefined) return null;
  const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
}
