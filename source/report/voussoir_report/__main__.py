"""Makes a report of one run, of several to compare, or of a study."""

import argparse
import concurrent.futures
import multiprocessing
import pathlib
import sys

EPILOG = """RUN is the output folder of a run, or LABEL=FOLDER to name the run in legends; the
folder of a study stands for its runs, some of them in detail, and adds a table and curves.
The page is self-contained and can be sent by mail; with a FILE that ends in .pdf the report
is a PDF (needs the package weasyprint)."""


def arguments():
    parser = argparse.ArgumentParser(
        prog="voussoir-report", description=__doc__, epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", metavar="RUN", help="output folder of a run "
                                                                      "or of a study")
    parser.add_argument("-o", "--output", metavar="FILE", help="the report (report.html in the folder of "
                                                               "the first run)")
    parser.add_argument("--pictures", metavar="FOLDER", help="also writes the pictures to this folder, as SVG and PNG")
    parser.add_argument("--case-folder", metavar="FOLDER", action="append", default=[],
                        help="folder of the parameter file, to find the records that it names")
    return parser.parse_args()


def with_runs_of_studies(folders, studies):
    """The arguments with the runs of a study instead of its folder."""
    result = []
    for folder in folders:
        if study := studies.get(folder):
            result += [f"{study.label_of(run)}={study.folder_of(run)}" for run in study.in_detail]
        else:
            result.append(folder)
    return result


def section_of(make, *arguments):
    """The section that a function makes of the runs. Damaged files are refused by name;
    any other exception that they cause becomes a sentence, too."""
    from .files import ReportError
    try:
        return make(*arguments)
    except ReportError:
        raise
    except Exception as error:
        what = make.__name__.removesuffix("_section").replace("_", " ")
        folders = ", ".join(f'"{run.folder}"' for run in arguments[0])
        raise ReportError(f'The section on {what} cannot be made from the results in {folders} '
                          f"({type(error).__name__}: {error}); if their files are complete, "
                          "please report this error.") from None


def main():
    options = arguments()
    try:
        # these imports take a second; --help does not need them
        from . import (case, damage, faces, interfaces, motions, over_stress, page, records, scenes,
                       stages, structure, study)
        from .files import ReportError
        from .run import read_runs
    except ImportError as error:
        sys.exit(f"voussoir-report: {error}; install python3-numpy, python3-matplotlib, python3-vtk9 "
                 "and python3-jinja2.")
    try:
        studies = {folder: study.Study(folder) for folder in options.runs if study.is_study(folder)}
        runs = read_runs(with_runs_of_studies(options.runs, studies))
        folder = next(iter(studies.values())).folder if studies else runs[0].folder
        file = pathlib.Path(options.output or folder / "report.html")
        page.check(file)
        scenes.open_display()
        records.CASE_FOLDERS += options.case_folder
        makers = (case.conclusions_section, case.headline_section, structure.scene_section, case.case_section,
                  structure.mesh_section, stages.stages_section, structure.modes_section, motions.input_section,
                  motions.motion_section, faces.face_stress_section, over_stress.over_stress_section,
                  interfaces.contraction_joints_section, interfaces.lift_joints_section, structure.opened_section,
                  interfaces.planes_section, damage.damage_section, motions.energy_section, case.statistics_section, case.files_section,
                  case.input_entries_section)
        # drawing takes nearly all of the time: one process for each core
        fork = multiprocessing.get_context("fork")
        with concurrent.futures.ProcessPoolExecutor(mp_context=fork) as pool:
            pending = [pool.submit(section_of, study.study_section, runs, list(studies.values())),
                       *(pool.submit(section_of, make, runs) for make in makers)]
            ended, _ = concurrent.futures.wait(pending, return_when=concurrent.futures.FIRST_EXCEPTION)
            for made in ended:
                if problem := made.exception():
                    pool.shutdown(cancel_futures=True)
                    raise problem
            sections = [section for section in (made.result() for made in pending) if section]
        page.write(runs, sections, file)
        if options.pictures:
            page.write_pictures(sections, pathlib.Path(options.pictures))
    except ReportError as error:
        sys.exit(f"voussoir-report: {error}")
    except concurrent.futures.process.BrokenProcessPool:
        sys.exit("voussoir-report: a drawing process was killed, perhaps for lack of "
                 "memory; try again with fewer runs.")
    print(f"The report is in {file}")


if __name__ == "__main__":
    main()
