"""Compiles the report with Typst, from the root of the repository; a warning is an error."""
import pathlib
import sys

import typst

ok = True
for name in ("rapport", "report"):
    source, output = pathlib.Path("report", f"{name}.typ"), pathlib.Path("target/report", f"{name}.pdf")
    try:
        # Only the fonts that Typst brings along, so that the pages are the same everywhere.
        _, warnings = typst.compile_with_warnings(
            str(source), output=str(output), root="report", ignore_system_fonts=True
        )
    except typst.TypstError as error:
        print(error.diagnostic, file=sys.stderr)
        ok = False
        continue
    for warning in warnings:
        print(warning.diagnostic, file=sys.stderr)
        ok = False
    if not warnings:
        print(output)
sys.exit(0 if ok else 1)
