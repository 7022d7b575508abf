// Phones and narrow windows: the view comes first; settings, lecture and plots open below it. shell.css has the same
// limit. A page with an engine opens in the same way, because its readers look before they choose settings.
import { hasEngine } from "./engine";

const kNarrow = "(max-width: 48rem)";

// Reports now, and after each change.
export function whenNarrow(reported: (narrow: boolean) => void): void {
  const query = matchMedia(kNarrow);
  query.addEventListener("change", () => reported(query.matches));
  if (query.matches || hasEngine()) reported(true);
}
