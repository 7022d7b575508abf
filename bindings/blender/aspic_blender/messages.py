"""Notes and errors of the program, for users of Blender."""
import re

MOST_NOTES = 3
COMMON = re.compile(  # notes about choices that need no change
    r"a surface; filled with|edges are as short as|^contact (of .* )?begins at|skin vertices are outside|m from itself instead")


def large(ob, size, unit):
    """A warning about an object that is probably not meant in meters, or None."""
    if size <= 10:
        return None
    scale = f", Unit Scale is {unit:.3g}" if unit != 1 else ""
    return (f"{ob.name} is {size:.3g} m large{scale}; if that is not meant, change its scale or Scene > Units > "
            "Unit Scale")


def in_blender(text, objects):
    """The text with names of objects instead of those of bodies and files."""
    text = re.sub(r"(?:body|obstacle) '([\w-]+)'", r"\1", text)
    return re.sub(r"(?<![\w.-])([\w-]+)(\.ply|\.mesh)?(?![\w-])", lambda m: objects.get(m[1], m[0]), text)


def note_lines(lines, job):
    """Warnings of the job, and the notes in lines of the log that need a decision; the first few."""
    notes = [line[len("note: "):] for line in lines if line.startswith("note: ")]
    shown = job.get("warnings", []) + [in_blender(note, job.get("objects", {})) for note in notes if not COMMON.search(note)]
    count = len(shown)
    if count > MOST_NOTES:
        shown[MOST_NOTES - 1:] = [f"and {count - MOST_NOTES + 1} more; all notes are in log.txt"]
    return count, shown
