// Phones and narrow windows: the view comes first; settings, lecture and plots open below it. shell.css has the same
// limit.
const kNarrow = "(max-width: 48rem)";

// Reports after each change, and now if the window is narrow, or if it `isClosed` at first in any window.
export function whenNarrow(isClosed: boolean, reported: (narrow: boolean) => void): void {
  const query = matchMedia(kNarrow);
  query.addEventListener("change", () => reported(query.matches));
  if (query.matches || isClosed) reported(true);
}
