"""The tutorial of C is followed word for word, with the installed library."""

from tutorial import Reader


def test_tutorial(prefix, opendr, tmp_path):
    folder = tmp_path / "reader"
    folder.mkdir()
    library = {"PKG_CONFIG_PATH": str(prefix / "lib/pkgconfig"), "LD_LIBRARY_PATH": str(prefix / "lib")}
    with Reader("c_embedded.md", folder, {**opendr.environment, **library}, {"opendr": opendr.binary}) as reader:
        reader.follow()
