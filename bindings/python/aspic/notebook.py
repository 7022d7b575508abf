"""Objects that notebooks show."""
import html


def in_notebook() -> bool:
    """Whether this is the kernel of a notebook."""
    try:
        from IPython import get_ipython
    except ImportError:
        return False
    shell = get_ipython()
    return shell is not None and hasattr(shell, "kernel")


class Player:
    """A page in a frame of its own. It needs neither a server nor a kernel."""

    def __init__(self, page, height=600) -> None:
        self.page, self.height = page, height

    def _repr_html_(self):
        return (f'<iframe sandbox="allow-scripts" style="width: 100%; height: {int(self.height)}px; border: 0" '
                f'srcdoc="{html.escape(self.page, quote=True)}"></iframe>')

    def __repr__(self):
        return f"<Player: {len(self.page) / 1e6:.1f} MB; save(path) writes it as a file>"

    def save(self, path) -> None:
        """Writes the page; any browser opens it."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.page)
