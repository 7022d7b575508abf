// The bench and the report of a fit, as parts of the page.
import { extensions } from "../../web/src/extensions";
import { BenchPanel } from "./bench/panel";
import { IndenterTool } from "./bench/tool";
import { openFit } from "./fit/fitPage";

extensions.push({
  document: { id: "fit", open: openFit },
  addTo(store, page, display, dock) {
    const tool = new IndenterTool();
    display.addTool("press an indenter in", tool);
    const panel = new BenchPanel(store, page, display, tool);
    const stop = store.on("extension", () => {
      stop(); // the program has the bench
      dock().add(panel);
    });
  },
});
