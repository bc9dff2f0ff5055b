"""What the book says of the package runs as it is printed, and so does the template for CI."""

import re
import shutil
import subprocess
import sys

import numpy as np
import pytest

from lmpc_quadrotor.pytest_plugin.options import Options

#: Pages whose blocks are programs, each for itself.
PROGRAMS = ["python/start", "python/simulate", "python/control", "python/gym"]
#: Pages whose blocks are parts of one program.
PARTS = ["tutorials/monte-carlo", "tutorials/own-plant", "explanations/why-laguerre"]


def blocks(repository, page):
    """Title and text of each block of Python in a page."""
    text = (repository / "book" / "src" / f"{page}.md").read_text()
    found = re.findall(r'^```python title="([^"]+)"\n(.*?)^```', text, re.DOTALL | re.MULTILINE)
    assert len(found) == text.count("```python"), "a block has no title, by which the other tests pass over it"
    return found


@pytest.mark.parametrize("page", PROGRAMS + PARTS)
def test_programs_run_as_printed(repository, page, capsys):
    scope = {}
    for title, text in blocks(repository, page):
        scope = scope if page in PARTS else {}
        exec(compile(text, title, "exec"), scope)  # noqa: S102
        printed = capsys.readouterr().out.strip().splitlines()
        told = [told for line in text.splitlines() if (told := re.search(r"print\(.*\)  # (.*)$", line))]
        shown = [line for line, source in zip(printed, re.findall(r"print\(.*", text)) if "  # " in source]
        for one, line in zip(told, shown):
            try:
                numbers = [[float(word) for word in text.split()] for text in (line, one[1])]
            except ValueError:
                assert line == one[1]
            else:
                np.testing.assert_allclose(*numbers, atol=0.0101)


def test_the_examples_of_the_fixture_pass(repository, pytester):
    parts = blocks(repository, "python/pytest")
    for title in {title for title, _ in parts}:
        pytester.path.joinpath(title).write_text("\n\n".join(text for other, text in parts if other == title))
    pytester.runpytest_subprocess("-p", "no:cacheprovider").assert_outcomes(passed=6)


def test_the_table_of_options_is_complete(repository):
    text = (repository / "book" / "src" / "python" / "pytest.md").read_text()
    for name in Options.__dataclass_fields__:
        assert re.search(rf"`{name}[`=]", text), name


def test_the_template_passes_in_seconds(repository, pytester):
    shutil.copytree(repository / "examples" / "ci", pytester.path / "template")
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "--numprocesses", "2"],
        cwd=pytester.path / "template", capture_output=True, text=True, timeout=200,
    )  # fmt: skip
    assert done.returncode == 0 and "5 passed" in done.stdout, done.stdout + done.stderr
    assert not (pytester.path / "template" / "failed-flights").exists()
