"""The search over all layouts, and the duty cycle, as their user runs them."""

import json
import unittest

from capstan_program import CONFIGS, CapstanTest

PAPER = (CONFIGS / "paper.toml", "--repetitions", "40")


class Place(CapstanTest):
    def answer(self, *words):
        return json.loads(self.run_capstan("place", *words, "--json").stdout)

    def config_with(self, placement, name="my.toml"):
        text = PAPER[0].read_text() + "\n[placement]\n" + placement
        (self.folder / name).write_text(text)
        return name

    def test_all_layouts_of_the_papers_cable_with_the_families_beside(self):
        answer = self.answer(*PAPER)
        self.assertEqual(answer["layouts"], 2047)
        self.assertEqual(answer["search"], "exhaustive")
        scopes = [(scope["scope"], scope.get("regime")) for scope in answer["scopes"]]
        self.assertEqual(scopes, [("regime", "mass"), ("regime", "partial_proximal"), ("minimax_regret", None),
                                  ("duty_cycle", None)])
        for scope in answer["scopes"]:
            self.assertEqual([count["sensor_count"] for count in scope["counts"]], list(range(1, 12)))
            for count in scope["counts"]:
                beside = {layout["how"] for layout in count["beside"]}
                self.assertLessEqual({"even", "distal", "both"}, beside)
        words = self.run_capstan("place", *PAPER).stdout
        self.assertIn("12282 candidates (layouts times fusion methods)", words)

    def test_any_number_of_jobs_gives_the_same_bits(self):
        answers = {self.run_capstan("place", *PAPER, "--json", "--jobs", jobs).stdout for jobs in (1, 2, 7, 16)}
        self.assertEqual(len(answers), 1)

    def test_constraints_are_kept(self):
        config = self.config_with("forbidden_nodes = [11]\nrequired_nodes = [1]\nminimum_spacing = 2\n"
                                  "max_in_distal_half = 1\nbudget = 3\n")
        for scope in self.answer(config, "--repetitions", 20)["scopes"]:
            self.assertEqual(scope["counts"][-1]["sensor_count"], 3)
            for count in scope["counts"]:
                nodes = count["optimum"]["nodes"]
                self.assertIn(1, nodes)
                self.assertNotIn(11, nodes)
                self.assertLessEqual(sum(node > 6 for node in nodes), 1)
                self.assertTrue(all(b - a >= 2 for a, b in zip(nodes, nodes[1:])))

    def test_constraints_that_clash_are_named_with_their_line(self):
        config = self.config_with("forbidden_nodes = [2]\nrequired_nodes = [2, 5]\nbudget = 7\n")
        line = 1 + (self.folder / config).read_text().splitlines().index("required_nodes = [2, 5]")
        refused = self.run_capstan("place", config, expect=2)
        self.assertIn(f"my.toml:{line}:", refused.stderr)
        self.assertIn("no layout satisfies required_nodes = [2, 5], forbidden_nodes = [2] together", refused.stderr)
        self.assertNotIn("budget", refused.stderr)

    def test_an_unknown_constraint_is_refused_with_the_nearest(self):
        refused = self.run_capstan("place", self.config_with("forbiden_nodes = [2]\n"), expect=2)
        self.assertIn("did you mean 'forbidden_nodes'?", refused.stderr)

    def test_a_data_sheet_is_read(self):
        text = PAPER[0].read_text().replace("multiplicative_ratio = 0.1",
                                            "multiplicative_ratio = 0.1\nquantisation_N = 0.5\nrange_N = 12")
        (self.folder / "sheet.toml").write_text(text)
        coarse = self.answer("sheet.toml", "--repetitions", 40)["scopes"][0]["counts"][0]["optimum"]["error_N"]
        fine = self.answer(*PAPER)["scopes"][0]["counts"][0]["optimum"]["error_N"]
        self.assertNotEqual(coarse, fine)

    def test_the_page_needs_no_network(self):
        self.run_capstan("place", *PAPER, "--html", "place.html", "-o", "place.txt")
        self.assertIn("Where the sensors go", (self.folder / "place.html").read_text())


class Duty(CapstanTest):
    def setUp(self):
        super().setUp()
        # Torque ramps against a locked load.
        self.run_capstan("simulate", CONFIGS / "bench-ramps.toml", "-o", "bench.csv")

    def test_shares_sum_to_one_and_place_takes_them(self):
        duty = json.loads(self.run_capstan("duty", "bench.csv", "--json").stdout)
        self.assertAlmostEqual(sum(duty["duty_fraction"].values()), 1.0)
        self.assertGreater(duty["duty_fraction"]["partial_proximal"], 0.2)  # creeping after each reversal
        told = self.run_capstan("place", *PAPER, "--duty", "bench.csv")
        self.assertIn("duty cycle from bench.csv: mass", told.stderr)
        words = self.run_capstan("duty", "bench.csv").stdout
        self.assertIn("duty_fraction", words)


if __name__ == "__main__":
    unittest.main()
