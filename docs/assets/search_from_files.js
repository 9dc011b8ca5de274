// Search in pages that are opened as files: browsers let these neither fetch the index nor start a worker. The index is
// a script then, and the worker a hidden frame. Pages from a server do not need this.
if (location.protocol === "file:") {
  const root = document.currentScript.src.replace("assets/search_from_files.js", "");
  document.write(`<script src="${root}search/search_index.js"></script>`);

  window.Worker = class extends EventTarget {
    constructor(url) {
      super();
      const frame = document.createElement("iframe");
      frame.hidden = true;
      document.body.append(frame);
      this.inside = frame.contentWindow;
      this.inside.postMessage = data => this.dispatchEvent(new MessageEvent("message", {data}));
      const script = this.inside.document.createElement("script");
      this.loaded = new Promise(resolve => script.onload = resolve);
      script.src = url;
      this.inside.document.body.append(script);
    }
    postMessage(data) {
      this.loaded.then(() =>
        this.inside.dispatchEvent(new this.inside.MessageEvent("message", {data})));
    }
    terminate() {}
  };
}
