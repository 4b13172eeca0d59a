"""The package against the program that the variable LANCER names."""

import json
import pathlib
import tempfile
import unittest
import warnings

import numpy

import lancer

FOLDER = pathlib.Path(__file__).resolve().parent.parent


class Command(unittest.TestCase):
    def test_keywords_become_options(self):
        words = lancer.arguments(size=(8, 6), no_error=True, word=None, shift=(-0.5, 1), format={"dir": 24, "t": 20})
        expected = ["--size=8x6", "--no-error", "--shift=-0.5,1", "--format", "dir=24", "--format", "t=20"]
        self.assertEqual(words, expected)

    def test_mistakes_are_exceptions_with_messages(self):
        with self.assertRaises(lancer.LancerError) as caught:
            lancer.run("    vdto s4, v1, v2\n")
        self.assertEqual(caught.exception.code, 1)
        self.assertEqual(caught.exception.messages[0]["help"], "did you mean `vdot`?")
        with self.assertRaises(lancer.LancerError) as caught:
            lancer.render("cornell", size="4")
        self.assertEqual(caught.exception.code, 2)

    def test_warnings_are_warnings(self):
        with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            lancer.call("scene", "convert", "triangle", folder + "/a.off")
        self.assertEqual([one.category for one in caught], [lancer.LancerWarning])


class Results(unittest.TestCase):
    def test_a_picture_is_an_array_and_its_figures_are_tables(self):
        one = lancer.render("cornell", size=(16, 12))
        self.assertEqual((one.picture.shape, one.picture.dtype), ((12, 16, 3), numpy.float32))
        self.assertTrue(0.05 < one.picture.mean() < 1 and one.psnr > 100)
        self.assertEqual(one.cores.busy.sum() + one.cores.waiting.sum() + one.cores.idle.sum(), 4 * one["clocks"])
        self.assertEqual(one.functions.loc["triangle", "exclusive.cmp"] > 0, True)

    def test_rows_of_pictures_are_upright(self):
        whole = lancer.render("cornell", size=(8, 6)).picture
        part = lancer.render("cornell", size=(8, 6), crop=(2, 1, 3, 2)).picture
        numpy.testing.assert_array_equal(part, whole[1:3, 2:5])

    def test_results_are_rows(self):
        pictures = [lancer.render("triangle", picture=False, size=(4, 4), word=word) for word in (32, 24)]
        table = lancer.frame(pictures)
        self.assertEqual(list(table["formats.word"]), [32, 24])
        self.assertEqual(list(table["clocks"]), [one["clocks"] for one in pictures])
        differences = lancer.diff(*pictures)
        self.assertEqual(differences.loc["formats.word", "percent"], -25)

    def test_a_sweep_has_a_row_for_each_combination(self):
        table = lancer.sweep(["triangle", "cornell"], size=(4, 3), word=[32, 24], cores=[1, 2], shift=(0.1, 0.2))
        self.assertEqual((len(table), sorted(set(table.scene))), (8, ["cornell", "triangle"]))
        one = lancer.render("cornell", picture=False, size=(4, 3), word=24, cores=2, shift=(0.1, 0.2))
        row = table[(table.scene == "cornell") & (table.word == 24) & (table.cores == 2)]
        self.assertEqual(list(row.clocks), [one["clocks"]])
        study = {"settings": {"view.size": [4, 3]}, "product": {"scene": ["triangle"]}, "zip": [{"word": [32, 20], "cores": [1, 3]}]}
        table = lancer.sweep(study).sort_values("word")
        self.assertEqual(list(zip(table.word, table.cores)), [(20, 3), (32, 1)])
        with self.assertRaises(lancer.LancerError) as caught:
            lancer.sweep("triangle", wort=[1, 2])
        self.assertTrue(caught.exception.messages)

    def test_programs_and_machines(self):
        self.assertEqual(lancer.run("    li s1, 7\n    halt\n")["registers"]["s1"], 7)
        self.assertEqual(lancer.machine("wide32")["bus"]["octets_per_beat"], 4)
        self.assertTrue(lancer.version()[0].isdigit())


class Notebook(unittest.TestCase):
    def test_cells_run_in_their_order(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("there is no matplotlib, which the notebook draws with")
        matplotlib.use("Agg")
        for path in sorted((FOLDER / "notebooks").glob("*.ipynb")):
            notebook = json.loads(path.read_text(encoding="utf-8"))
            names = {"__name__": "notebook"}
            for number, cell in enumerate(notebook["cells"]):
                if cell["cell_type"] == "code":
                    exec(compile("".join(cell["source"]), f"{path.name}[{number}]", "exec"), names)
                    self.assertEqual(cell["outputs"], [], "outputs are not kept")
            front = names["front"]
            self.assertTrue(2 <= len(front) < len(names["points"]))
            self.assertTrue(front.pixel_clocks.is_monotonic_increasing and front.psnr_db.is_monotonic_increasing)


if __name__ == "__main__":
    unittest.main()
