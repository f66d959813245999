"""Runs programs in sequence, each in a folder of its own, and prints a line of JSON with the result of each.

run_programs.py FOLDER PROGRAM...
"""

import json
import os
import runpy
import sys
import time
import traceback
import warnings


def main(folder, *programs):
    warnings.simplefilter("ignore", UserWarning)
    for program in programs:
        place = os.path.join(folder, os.path.splitext(os.path.basename(program))[0])
        os.makedirs(place)
        os.chdir(place)
        begin, failure = time.perf_counter(), None
        try:
            runpy.run_path(program, run_name="__main__")
        except BaseException:
            failure = traceback.format_exc()
        line = {"program": program, "seconds": round(time.perf_counter() - begin, 2), "failure": failure}
        print("\n" + json.dumps(line), flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
