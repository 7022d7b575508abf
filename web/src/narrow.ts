// Phones and narrow windows: the view comes first, and the settings, the lecture and the plots open below it.
// shell.css has the same limit.
const kNarrow = "(max-width: 48rem)";

// Now, and whenever it changes.
export function whenNarrow(reported: (narrow: boolean) => void): void {
  const query = matchMedia(kNarrow);
  query.addEventListener("change", () => reported(query.matches));
  if (query.matches) reported(true);
}
