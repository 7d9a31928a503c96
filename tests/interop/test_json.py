"""The JSON of `odkit convert` against its schema, with a validator of others."""

import json
import subprocess
import unittest

import jsonschema

from bench import ROOT, odkit

SCHEMA = ROOT / "docs" / "odkit-dictionary-2.schema.json"
FOLDERS = [ROOT / "devices" / "eds", ROOT / "crates/od-eds/cases", ROOT / "tests" / "cases"]
ENDINGS = {".eds", ".dcf", ".xdd", ".xdc"}


def validator():
    schema = json.loads(SCHEMA.read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def converted(path):
    """The text for a file; `None` if the file defines no object."""
    done = subprocess.run(
        [odkit(), "convert", str(path), "--to", "json", "--lossy"],
        capture_output=True, text=True, timeout=60,
    )
    if done.returncode != 0:
        assert "does not define any object" in done.stderr, f"{path}: {done.stderr}"
        return None
    return json.loads(done.stdout)


class Schema(unittest.TestCase):
    def test_every_case_is_valid(self):
        check = validator()
        seen = 0
        for folder in FOLDERS:
            for path in sorted(folder.rglob("*")):
                # A fixed case differs from the bad one in a line.
                if path.suffix.lower() not in ENDINGS or path.stem == "fixed":
                    continue
                made = converted(path)
                if made is None:
                    continue
                seen += 1
                faults = [f"{fault.json_path}: {fault.message}" for fault in check.iter_errors(made)]
                self.assertEqual(faults, [], path)
        self.assertGreater(seen, 150)

    def test_what_the_schema_does_not_have_is_not_valid(self):
        check = validator()
        made = converted(ROOT / "devices" / "eds" / "GXMM.eds")
        self.assertTrue(check.is_valid(made))
        for spoil in (
            lambda made: made.pop("identity"),
            lambda made: made["objects"][0].update(index="1000"),
            lambda made: made["objects"][0]["entries"][0].update(access="r"),
            lambda made: made["objects"][0]["entries"][0].update(default={"hex": "1"}),
            lambda made: made["objects"][0]["entries"][0].update(own=1),
        ):
            spoilt = json.loads(json.dumps(made))
            spoil(spoilt)
            self.assertFalse(check.is_valid(spoilt))


if __name__ == "__main__":
    unittest.main()
