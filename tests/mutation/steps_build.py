"""The sources of pure_steps.txt and their tests, compiled alone with clang-16 and linked with the libraries of the Release
build in build/. What is listed is linked first and wins over its copy in a library."""

import hashlib
import json
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
COMPILER = "clang++-16"


def end(text):
    print(f"{Path(sys.argv[0]).name}: {text}", file=sys.stderr)
    sys.exit(2)


def listed():
    """The tests of each source, and the reasons of what is unreachable by source and line's text."""
    tests_of, unreachable = {}, {}
    for line in (ROOT / "tests/mutation/pure_steps.txt").read_text().splitlines():
        if not line or line.startswith("#"):
            continue
        if line.startswith("unreachable "):
            source, text, reason = (part.strip() for part in line.removeprefix("unreachable ").split("|", 2))
            unreachable[source, text] = reason
            continue
        source, *tests = line.split()
        for path in (source, *tests):
            if not (ROOT / path).is_file():
                end(f"{path} is in tests/mutation/pure_steps.txt and not in the tree: correct the list")
        tests_of[source] = tests
    return tests_of, unreachable


class Build:
    """Objects in a folder of build/, compiled again when what they were compiled from has changed."""

    def __init__(self, name, wanted):
        for program in (COMPILER, *wanted):
            if shutil.which(program) is None:
                subprocess.run([ROOT / "service/install-packages", "clang-16", "llvm-16"], check=True)
        release = ROOT / "build"
        commands = release / "compile_commands.json"
        if not commands.is_file():
            end("build/ has no Release build, whose libraries are linked: run service/build first")
        self.folder = release / name
        self.folder.mkdir(exist_ok=True)
        self.flags = ["-std=c++20", "-O0", "-DNDEBUG", "-Wno-everything", *_flags_of_tests(json.loads(commands.read_text()))]
        link = subprocess.run(["ninja", "-C", release, "-t", "commands", "bin/service_test"], check=True, text=True,
                              capture_output=True).stdout.splitlines()[-1]
        arguments = shlex.split(re.search(r" -o bin/service_test (.*?) && :", link).group(1))
        self.libraries = [str(release / a) if a.endswith(".a") and not a.startswith("/") else a for a in arguments]

    def compile(self, source, target, *options):
        """The compiler's answer; `source` may lie anywhere."""
        return subprocess.run([COMPILER, *self.flags, *options, source, "-o", target], capture_output=True, text=True)

    def object_of(self, path, *options):
        """The object of a file of the tree."""
        target = self.folder / (path.replace("/", "_") + ".o")
        stamp = target.with_suffix(".stamp")
        text = (ROOT / path).read_text() + repr((options, self.flags))
        digest = hashlib.sha256(text.encode()).hexdigest()
        newest = max(f.stat().st_mtime for f in (ROOT / "build").glob("**/lib*.a"))
        if target.exists() and stamp.exists() and stamp.read_text() == digest and target.stat().st_mtime > newest:
            return target
        answer = self.compile(ROOT / path, target, "-c", *options)
        if answer.returncode != 0:
            end(f"{path} does not compile:\n{answer.stderr[:4000]}")
        stamp.write_text(digest)
        return target

    def link(self, objects, program, *options):
        answer = subprocess.run([COMPILER, "-fuse-ld=gold", "-Wl,--allow-multiple-definition", *options, *objects, "-o", program,
                                 *self.libraries], capture_output=True, text=True)
        if answer.returncode != 0:
            end(f"{program} cannot be linked:\n{answer.stderr[:4000]}")


def _flags_of_tests(commands):
    """Macros and folders of headers of service_test, which uses all that is listed."""
    words = next(shlex.split(c["command"]) for c in commands if "service_test.dir" in c["command"])
    flags = []
    for i, word in enumerate(words):
        if word.startswith(("-D", "-I")):
            flags.append(word)
        elif word == "-isystem":
            flags += [word, words[i + 1]]
    return flags


def lines_of(source):
    return (ROOT / source).read_text().splitlines()
