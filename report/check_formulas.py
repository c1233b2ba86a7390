"""Compares the report's formulas (formulas.toml) with the code that computes them.

Each formula names a file, and text that must stand in it. Where the code's documentation writes the formula out, the two
are also compared term by term. And each formula must be used by both languages, and be in the table of README.md.
"""
import pathlib
import re
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
REPORT = ROOT / "report"


def text_of(path):
    """A file's text on one line, without the marks of comments."""
    lines = path.read_text(encoding="utf-8").splitlines()
    return " ".join(" ".join(re.sub(r"^\s*//[/!]?", "", line) for line in lines).split())


def terms(formula):
    """A formula as a list of symbols, alike for Typst's notation and for that of the documentation."""
    formula = re.sub(r"sum_\(i=1\)\^[MN]", "sum_i", formula)
    for typst, plain in (("dot.c", "."), (")^+", ")+"), ("omega", "w"), ("(4 / N)", "4 / N")):
        formula = formula.replace(typst, plain)
    return re.findall(r"\w+|[^\w\s]", formula)


def faults():
    formulas = tomllib.loads((REPORT / "formulas.toml").read_text(encoding="utf-8"))
    readme = (REPORT / "README.md").read_text(encoding="utf-8")
    sources = {name: (REPORT / name).read_text(encoding="utf-8") for name in ("rapport.typ", "report.typ")}
    model = (REPORT / "formulas.typ").read_text(encoding="utf-8")
    for name, formula in formulas.items():
        path = ROOT / formula["file"]
        if not path.is_file():
            yield f"{name}: {formula['file']} does not exist"
        elif " ".join(formula["code"].split()) not in text_of(path):
            yield f"{name}: `{formula['code']}` is not in {formula['file']}"
        if "plain" in formula:
            if terms(formula["typst"]) != terms(formula["plain"]):
                yield f"{name}: `{formula['typst']}` and `{formula['plain']}` differ"
            documented = formula.get("plain_file", formula["file"])
            if formula["plain"] not in text_of(ROOT / documented):
                yield f"{name}: `{formula['plain']}` is not in {documented}"
        if not any(f"| {name} |" in line and formula["file"] in line for line in readme.splitlines()):
            yield f"{name}: report/README.md does not say that it is in {formula['file']}"
        for source, text in sources.items():
            if f'"{name}"' not in model + text:
                yield f"{name}: {source} does not use it"
    # The parts of the model, put together, are the formula that the code's documentation opens with.
    parts = [formulas[part]["plain"] for part in ("ambient", "lights", "diffuse", "specular", "recursive")]
    whole = "L = {} + {} [ {} + {} ]".format(*parts[:4])
    if whole not in text_of(ROOT / formulas["ambient"]["file"]):
        yield f"the model, `{whole}`, is not in {formulas['ambient']['file']}"


found = list(faults())
for fault in found:
    print(f"report/formulas.toml: {fault}", file=sys.stderr)
sys.exit(1 if found else 0)
