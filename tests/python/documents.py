"""Blocks of code in README.md and in the pages of the book, by language."""

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Block:
    file: str
    line: int
    language: str
    text: str

    def __str__(self) -> str:
        return f"{self.file}:{self.line}"

    @property
    def commands(self) -> list[list[str]]:
        """The arguments of each start of lmpc-sitl, in a block of shell commands."""
        lines = self.text.replace("\\\n", " ").splitlines()
        return [arguments for line in lines if (arguments := sitl_arguments(line)) is not None]


def sitl_arguments(line: str) -> list[str] | None:
    """The arguments of lmpc-sitl, if this is a command that starts it."""
    words = shlex.split(line, comments=True)
    while words and re.fullmatch(r"\$|[A-Z_]+=.*", words[0]):
        words = words[1:]
    if words and Path(words[0]).name == "lmpc-sitl":
        return words[1:]
    build, _, arguments = (words, None, []) if "--" not in words else (words[: words.index("--")], "--", words[words.index("--") + 1 :])
    is_program = build[:2] == ["cargo", "run"] and "sitl" in build and not {"--example", "--bin"} & set(build)
    return arguments if is_program else None


def blocks() -> list[Block]:
    """All blocks in the order in which a reader meets them; of a language if its name is all that stands behind the fence."""
    found = []
    book = ROOT / "book" / "src"
    for file in [ROOT / "README.md", *sorted(book.rglob("*.md"))]:
        text = file.read_text(encoding="utf-8")
        for match in re.finditer(r"^```(\w+)\n(.*?)^```", text, re.DOTALL | re.MULTILINE):
            line = text.count("\n", 0, match.start()) + 1
            found.append(Block(str(file.relative_to(ROOT)), line, match[1], match[2]))
    return found


def of(language: str, word: str = "") -> list[Block]:
    """Blocks of a language in which a word stands."""
    return [block for block in blocks() if block.language == language and word in block.text]


def check_output(block: Block, output: str):
    """The last line that the code prints has the numbers that the comment beside its last `print` tells."""
    prints = [line for line in block.text.splitlines() if "print(" in line]
    told = re.search(r"\)\s+#\s*(.*)$", prints[-1]) if prints else None
    expected = [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?", told[1])] if told else []
    if expected:
        printed = [float(number) for number in re.findall(r"-?\d+(?:\.\d+)?(?:e-?\d+)?", output.splitlines()[-1])]
        assert len(printed) >= len(expected), f"{block}: printed {output!r}, the comment says {told[1]!r}"
        for value, number in zip(printed, expected):
            assert abs(value - number) < 0.0101, f"{block}: printed {output!r}, the comment says {told[1]!r}"
