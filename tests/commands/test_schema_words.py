"""storage/README.md says of every table and column what the schema says, and its questions have the answers it gives."""

import os
import re
import unittest

from capstan_program import CONFIGS, CapstanTest

STORAGE = CONFIGS.parent / "storage"


class SchemaWords(CapstanTest):
    def test_the_readme_has_every_table_as_the_schema_says(self):
        words = self.run_capstan("query", "--schema", "--format", "md").stdout
        path = STORAGE / "README.md"
        readme = path.read_text()
        begin = readme.index("\n#### study\n")
        if "UPDATE_DOCUMENTS" in os.environ:
            path.write_text(readme[:begin] + words)
            return
        self.assertEqual(readme[begin:], words, "UPDATE_DOCUMENTS=1 with this test writes it anew")

    def test_no_column_is_without_words(self):
        words = self.run_capstan("query", "--schema", "--format", "md").stdout
        rows = re.findall(r"^\| `(\w+)` \| .* \| (.*) \|$", words, re.MULTILINE)
        self.assertGreater(len(rows), 200)
        self.assertEqual([name for name, meaning in rows if not meaning], [])
        self.run_capstan("query", "SELECT 1", "--format", "md", expect=2)

    def test_the_questions_have_the_answers_that_are_given(self):
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--progress", "none")
        path = STORAGE / "questions.md"
        text = path.read_text()
        pairs = re.findall(r"```sql\n(.*?)```\n\n```text\n(.*?)```", text, re.DOTALL)
        self.assertGreaterEqual(len(pairs), 10)
        for sql, answer in pairs:
            told = self.run_capstan("query", sql).stdout
            if "UPDATE_DOCUMENTS" in os.environ:
                text = text.replace(f"```sql\n{sql}```\n\n```text\n{answer}```", f"```sql\n{sql}```\n\n```text\n{told}```")
                path.write_text(text)
                continue
            with self.subTest(sql):
                self.assertEqual(told.split(), answer.split())


if __name__ == "__main__":
    unittest.main()
