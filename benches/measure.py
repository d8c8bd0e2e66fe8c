"""What `frames.py` and `stages.py` share: scenes, renders, and renders under valgrind."""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BINARY = ROOT / "target/release/caustica"
SIZE = (120, 90)
BUILT_IN = "built-in"
# The level-2 cache that is simulated as the last one: size in bytes, ways, bytes a line.
LEVEL_2 = "524288,8,64"
# Files and functions that write the picture.
OUTPUT = re.compile(r"\b(miniz_oxide|png|fdeflate|exr|zune_\w+)(-[\d.]+/|::)"
                    r"|film(/src/|::)(display|tonemap|openexr|output|picture)|powf")


def arguments(parser):
    """Adds the options that both programs have."""
    parser.add_argument("--binary", type=Path, default=BINARY, help="the program [default: target/release/caustica]")
    parser.add_argument("--scenes", default=f"{BUILT_IN},a,b,c,d",
                        help=f"{BUILT_IN}, letters of benches/peers, scene files; separated by commas")
    parser.add_argument("--peers", type=Path, default=ROOT / "benches/peers", help="folder with the peers' scenes.py")
    parser.add_argument("--work", type=Path, default=ROOT / "target/frames", help="folder for what is generated")


def scenes(options):
    """The scenes asked for, as pairs of a name and a file (`None`: built in). Leaves out, aloud, what is not there."""
    found = []
    for name in options.scenes.split(","):
        if name == BUILT_IN:
            found.append((name, None))
        elif Path(name).suffix == ".xml":
            found.append((Path(name).stem, Path(name)))
        elif file := _exported(name, options):
            found.append((name, file))
    return found


def _exported(name, options):
    file = options.work / "scenes" / name / "caustica.xml"
    if file.exists():
        return file
    sys.path.insert(0, str(options.peers))
    try:
        import scenes as peers
    except ImportError as error:
        print(f"scene {name} is left out: {error} (looked in {options.peers}; its scenes need numpy)", file=sys.stderr)
        return None
    peers.export(name, file.parent)
    return file


def render_command(binary, scene, integrator, samples, work):
    """A render on one thread, which prints its report as JSON."""
    command = [str(binary), "render", *([str(scene)] if scene else []), "--integrator", integrator, "--json"]
    return command + ["--spp", str(samples), "--resolution", f"{SIZE[0]}x{SIZE[1]}", "--threads", "1",
                      "-o", str(work / "frame")]


def _run(command):
    # One thread builds the tree, so that it is the same work every time.
    done = subprocess.run(command, env=os.environ | {"RAYON_NUM_THREADS": "1"}, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
    return done.stdout


def seconds(binary, scene, integrator, samples, work):
    """How long rendering takes, without loading and writing."""
    return json.loads(_run(render_command(binary, scene, integrator, samples, work)))["seconds"]


def has_valgrind():
    """Whether valgrind is there; says so if it is not."""
    if shutil.which("valgrind"):
        return True
    print("valgrind is not installed: no instructions are counted", file=sys.stderr)
    return False


def callgrind(binary, scene, integrator, samples, work, options=()):
    """Runs a render under callgrind and returns the file with the counts."""
    out = work / f"callgrind.{os.getpid()}.{samples}"
    tool = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", "--compress-pos=no",
            "--compress-strings=no", *options]
    _run(tool + render_command(binary, scene, integrator, samples, work))
    return out


def instructions(file):
    """All instructions of a callgrind file, but those that write the picture: how many depends on what is in it."""
    total, skip, counted = 0, False, True
    place = {"fl=": "", "fn=": "", "fi=": ""}  # file, function, file that a line was inlined from
    with open(file) as lines:
        for line in lines:
            if line.startswith(("fl=", "fn=", "fi=", "fe=")):
                if line[:3] in ("fl=", "fn="):
                    place["fi="] = ""
                place["fi=" if line[:3] == "fe=" else line[:3]] = line
                counted = not any(OUTPUT.search(p) for p in place.values())
            elif line.startswith("calls="):
                skip = True
            elif line[:1].isdigit():
                if counted and not skip:
                    total += int(line.split()[1])
                skip = False
    return total
