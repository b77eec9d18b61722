"""The answers of the worked examples, as the README states them: the first sentence of what the program prints."""

import re
import unittest

from capstan_program import CONFIGS, CapstanTest

SENTENCE = r"use [^\n|]+; without any sensor [\d.]+ N"


class WorkedExamples(CapstanTest):
    def test_answer_as_the_readme_says(self):
        shown = re.findall(rf"^([a-z ]+): ({SENTENCE})", (CONFIGS.parent / "README.md").read_text(), flags=re.M)
        listed = re.findall(rf"^\| `([a-z-]+)` \| ({SENTENCE}) \|", (CONFIGS / "README.md").read_text(), flags=re.M)
        self.assertEqual(len(shown), 3)
        self.assertEqual(len(listed), 4)
        stated = {name.replace(" ", "-"): sentence for name, sentence in shown}
        self.assertEqual(stated | dict(listed), dict(listed), "both documents say the same")
        for name, sentence in listed:
            with self.subTest(name):
                words = " ".join(self.run_capstan("place", CONFIGS / f"{name}.toml", "--progress", "none").stdout.split())
                self.assertEqual(words.partition(": ")[2].partition(". ")[0], sentence)


if __name__ == "__main__":
    unittest.main()
