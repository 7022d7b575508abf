"""Notes and errors of the program, for users of Blender."""
import re

MOST_NOTES = 3
COMMON = re.compile(  # notes about choices that need no change
    r"a surface; filled with|edges are as short as|^contact (of .* )?begins at|skin vertices are outside|m from itself instead")

WORDS = [(re.compile(pattern), words) for pattern, words in (  # of the program, of Blender
    (r"the surface is open: \d+ edges around (\d+ holes?).*",
     r"the surface is open (\1); Mesh > Clean Up > Fill Holes, Rebuild surface, or role Cloth"),
    (r"the surface intersects itself: (\d+ pairs? of triangles).*",
     r"the surface intersects itself (\1); Rebuild surface, or apply a Remesh modifier"),
    (r"(the mesh is planar|the surface is a sheet): .*", r"\1; role Cloth, or apply a Solidify modifier"),
    (r"(encloses almost no volume): .*", r"\1, too little to rebuild; role Cloth, or Mesh > Clean Up > Fill Holes"),
    (r"set material\.young = (\S+)", r"set Stiffness to \1 Pa"),
    (r"set body\.\S+\.scale = (\S+)", r"scale the object by \1"),
)]
PLACE = re.compile(r"(?:error: )?(?:\S.*?scene\.toml(?::(\d+):\d+)?: )?(?:mesh = \"[^\"]*\": )?(?:\S.*?[\\/]([\w-]+)\.ply: )?(.*)")


def large(ob, size, unit):
    """A warning about an object that is probably not meant in meters, or None."""
    if size <= 10:
        return None
    scale = f", Unit Scale is {unit:.3g}" if unit != 1 else ""
    return (f"{ob.name} is {size:.3g} m large{scale}; if that is not meant, change its scale or Scene > Units > "
            "Unit Scale")


def in_blender(text, objects):
    """The text in words of Blender, with names of objects instead of those of bodies and files."""
    for pattern, words in WORDS:
        text = pattern.sub(words, text)
    text = re.sub(r"(?:body|obstacle) '([\w-]+)'", r"\1", text)
    return re.sub(r"(?<![\w.-])([\w-]+)(\.ply|\.mesh)?(?![\w-])", lambda m: objects.get(m[1], m[0]), text)


def name_before(scene, line):
    """Name of the body or obstacle whose table has this line of scene.toml, or an empty text."""
    names = re.findall(r'^name = "(.*)"$', "\n".join(scene.splitlines()[:line]), re.MULTILINE)
    return names[-1] if names else ""


def error_text(text, scene, objects):
    """An error of the program without its place in the text of scene.toml, which users never open."""
    result = []
    for error in text.splitlines():
        line, name, rest = PLACE.match(error).groups()
        if not name and line:
            name = name_before(scene, int(line))
        ob, rest = objects.get(name, ""), in_blender(rest, objects)
        result.append(f"{ob}: {rest}" if ob and ob not in rest else rest)
    return "\n".join(result)


def note_lines(lines, job):
    """Warnings of the job, and the notes in lines of the log that need a decision; the first few."""
    notes = [line[len("note: "):] for line in lines if line.startswith("note: ")]
    shown = job.get("warnings", []) + [in_blender(note, job.get("objects", {})) for note in notes if not COMMON.search(note)]
    count = len(shown)
    if count > MOST_NOTES:
        shown[MOST_NOTES - 1:] = [f"and {count - MOST_NOTES + 1} more; all notes are in log.txt"]
    return count, shown
