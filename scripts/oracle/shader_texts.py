"""The texts of shaders/ in one language, put together in an order in which each has what it needs."""
import importlib.machinery
import importlib.util
import pathlib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
ORDER = ("bicubic bounce chart_transform hemisphere_bases hhd specular spherical_harmonics storage tangent_frame irradz l1 "
         "probe_hemisphere probe_hhd zh3").split()


def translator():
    """scripts/shaders as a module."""
    loader = importlib.machinery.SourceFileLoader("shaders", str(ROOT / "scripts" / "shaders"))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("shaders", loader))
    loader.exec_module(module)
    return module


def library(language):
    """As committed."""
    folder = ROOT / "shaders"
    missing = {p.stem for p in folder.glob("*.glsl")} - set(ORDER)
    if missing:
        raise SystemExit(f"shader_texts.py: ORDER lacks {missing}")
    return "\n".join((folder / f"{name}.{language}").read_text() for name in ORDER)


def cases(language):
    """What calls every function (tests/shaders/cases.glsl)."""
    text = (ROOT / "tests" / "shaders" / "cases.glsl").read_text()
    return text if language == "glsl" else translator().translate(text, language)
