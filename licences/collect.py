"""Prints the licences of all that is shipped: `./check print` writes THIRD-PARTY.txt, `./check licences` compares it.

Of each crate in the program or in the Python module on Linux it takes the files of its licence from its sources: of
several to choose from, the first of `CHOICE`. What is no crate has its text beside this script.
"""

import json
import subprocess
from collections import defaultdict
from pathlib import Path

HERE = Path(__file__).parent
PACKAGES = ["stickslip", "stickslip-ffi", "stickslip-python"]
TARGETS = ["x86_64-unknown-linux-gnu", "x86_64-unknown-linux-musl"]
#: Licences, as they are preferred, and parts of the names of their files.
CHOICE = {"MIT": "MIT", "ISC": "ISC", "BSD-3-Clause": "BSD", "Zlib": "ZLIB", "Apache-2.0": "APACHE"}
NAMES = ("LICENSE", "LICENCE", "COPYING", "NOTICE", "COPYRIGHT")
LINE = "-" * 80
HEAD = f"""Licences of what is shipped with stickslip

stickslip itself is under the MIT licence: see LICENSE. The program, the Python package and the image contain the
following parts, each under its own licence; the texts follow in groups, below the names that they hold for.
`./check print` writes this file.
"""


def cargo(*arguments: str) -> str:
    run = subprocess.run(["cargo", *arguments], cwd=HERE.parent, capture_output=True, text=True)
    if run.returncode:
        raise SystemExit(run.stderr)
    return run.stdout


def shipped() -> set[tuple[str, str]]:
    """Names and versions of the crates, without ours."""
    arguments = ["tree", "--locked", "--edges", "normal,no-proc-macro", "--prefix", "none"]
    for flag, values in (("--target", TARGETS), ("--package", PACKAGES)):
        arguments += [part for value in values for part in (flag, value)]
    lines = {line for line in cargo(*arguments).splitlines() if line and "(/" not in line}
    return {(name, version[1:]) for name, version, *_ in (line.split(" ") for line in lines)}


def texts(folder: Path, licence: str) -> list[str]:
    """The texts of a crate: of a choice of licences one, else all."""
    files = sorted(path for path in folder.iterdir() if path.name.upper().startswith(NAMES) and path.is_file())
    if " AND " not in licence:
        for name, part in CHOICE.items():
            chosen = [path for path in files if part in path.name.upper()]
            if name in licence and chosen:
                files = chosen + [path for path in files if path.name.upper().startswith("NOTICE")]
                break
    return [path.read_text(errors="replace").strip().replace("\r\n", "\n") for path in files]


def main() -> None:
    packages = json.loads(cargo("metadata", "--locked", "--format-version", "1"))["packages"]
    known = {(package["name"], package["version"]): package for package in packages}
    crates = defaultdict(list)
    without = defaultdict(list)
    for crate in sorted(shipped()):
        package = known[crate]
        licence = (package["license"] or "").replace("/", " OR ")
        found = texts(Path(package["manifest_path"]).parent, licence)
        if not found:
            without[licence].append(crate)
        for text in found:
            crates[text].append((*crate, licence))
    apache = next(text for text in crates if text.startswith("Apache License") and "TERMS AND CONDITIONS" in text)
    for licence, users in without.items():
        # Their sources have no text of it.
        assert licence == "Apache-2.0", (licence, users)
        crates[apache] += [(*crate, licence) for crate in users]
    lines = {
        text: [f"  {name} {version} ({licence})" for name, version, licence in sorted(users)]
        for text, users in crates.items()
    }
    parts = [path.read_text().rstrip() for path in sorted(HERE.glob("*.txt"))]
    print(HEAD)
    print(*sorted({line for users in lines.values() for line in users}), "", sep="\n")
    print(*(f"  {part.splitlines()[1].rstrip(':')}" for part in parts), "", sep="\n")
    for text, users in sorted(lines.items(), key=lambda item: item[1]):
        print(LINE, *users, "", text, "", sep="\n")
    print(*parts, sep="\n\n")


if __name__ == "__main__":
    main()
