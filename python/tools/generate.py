"""Writes the files of the package that follow from the OpenAPI document: `python tools/generate.py`.

They are the classes of replies, shapes and members of requests, the methods of the computations with their keywords,
and the units of all of them. A test compares what this prints with the files, so that nothing of the API is missing.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from methods_writer import functions_file, methods_file
from openapi_schemas import ROOT, document, fields
from requests_writer import members_file, profiles_file, types_file
from results_writer import reply_schemas, result_classes, results_file, schemas_file

__all__ = ["FILES", "fields", "reply_schemas", "result_classes"]

FILES = {
    "computations.py": methods_file,
    "functions.py": functions_file,
    "members.py": members_file,
    "profiles.py": profiles_file,
    "request_types.py": types_file,
    "results.py": results_file,
    "schemas.py": schemas_file,
}


def main() -> int:
    api = document()
    for name, write in FILES.items():
        (ROOT / "python" / "stickslip" / name).write_text(write(api))
    return 0


if __name__ == "__main__":
    sys.exit(main())
