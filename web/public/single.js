// Starts the article when it is a single file: unpacks the files that the page holds as text, and gives each an address.
(async () => {
  const text = async (address) => (await fetch(address)).text();
  const script = (program) => URL.createObjectURL(new Blob([program], { type: "text/javascript" }));
  // Without a server, a worker cannot be a module, and can fetch data URLs but no blobs.
  const data = (blob) => new Promise((done) => {
    const reader = new FileReader();
    reader.onload = () => done(reader.result);
    reader.readAsDataURL(blob);
  });
  const unpack = async (element) => {
    const packed = await (await fetch(`data:application/gzip;base64,${element.textContent.trim()}`)).blob();
    const { name, type } = element.dataset;
    const bytes = name.endsWith(".gz") ? packed : await new Response(packed.stream().pipeThrough(new DecompressionStream("gzip"))).blob();
    const file = new Blob([bytes], { type });
    if (name.endsWith(".worker.js")) return [name, script((await file.text()).replaceAll("import.meta.url", "self.location.href"))];
    return [name, name.endsWith(".wasm") ? await data(file) : URL.createObjectURL(file)];
  };
  globalThis.hedonFiles = Object.fromEntries(await Promise.all([...document.querySelectorAll("script[data-name]")].map(unpack)));
  const program = await text(hedonFiles["assets/story.js"]);
  await import(script(program.replace(/(from\s*|import\s*)"\.\/([\w.]+)"/g, (_, word, chunk) => `${word}"${hedonFiles[`assets/${chunk}`]}"`)));
})();
