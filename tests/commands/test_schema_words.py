"""The program explains every table and column of the database, and the questions of storage/questions.md have the answers
that are given."""

import contextlib
import os
import re
import sqlite3
import unittest

from capstan_program import CONFIGS, CapstanTest

STORAGE = CONFIGS.parent / "storage"


class SchemaWords(CapstanTest):
    def test_the_words_cover_every_table_and_column(self):
        """What `query --schema --format md` prints is what the database has."""
        self.run_capstan("study", "run", CONFIGS / "quick.toml", "--progress", "none")
        with contextlib.closing(sqlite3.connect(self.folder / "capstan.db")) as connection:
            names = [row[0] for row in connection.execute("SELECT name FROM sqlite_schema WHERE type IN ('table', 'view')")]
            columns = {name: [row[1] for row in connection.execute(f"PRAGMA table_info({name})")] for name in names}
        words = self.run_capstan("query", "--schema", "--format", "md").stdout
        documented = {}
        for section in words.split("\n#### ")[1:]:
            documented[section.split()[0]] = re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE)
        self.assertEqual(documented, columns)
        readme = (STORAGE / "README.md").read_text()
        self.assertEqual([name for name in names if f"`{name}`" not in readme], [])

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
