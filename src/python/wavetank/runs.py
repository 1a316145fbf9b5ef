"""Runs wavetank_run again and again, each run in a folder of its own, and goes on where it was stopped."""

import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time

import yaml

from wavetank import Failure

MARKER, BAG, LOG = "run.json", "out.bag", "log.txt"
STOPPED_BY_WATCHDOG = 3
INTERRUPTED = (130, 143, -2, -15)
FILE_KEYS = ("mesh", "file", "urdf")
TEXT = {"encoding": "utf-8", "errors": "replace"}  # what wavetank_run writes, whatever the locale


class Loader(yaml.SafeLoader):
    """Takes 1e-3 for a number, as wavetank does, which PyYAML takes for text."""


Loader.add_implicit_resolver("tag:yaml.org,2002:float", re.compile(r"^[-+]?(\d+(\.\d*)?|\.\d+)[eE][-+]?\d+$"), list("-+.0123456789"))


def read_yaml(text):
    return yaml.load(text, Loader)


class Run:
    """One run: a name, which is its folder's, the case's file, what is set (pairs of key and value, as text), and options of wavetank_run."""

    def __init__(self, name, case, settings=(), options=()):
        self.name, self.case, self.settings, self.options = name, case, list(settings), list(options)


class Result:
    """Of a run: exit_code and, where that is not 0, one sentence; the bag's path, or None if there is none."""

    def __init__(self, run, folder, exit_code, sentence, seconds):
        self.run, self.folder, self.exit_code, self.sentence, self.seconds = run, folder, exit_code, sentence, seconds
        path = os.path.join(folder, BAG)
        self.bag = path if os.path.isfile(path) else None


def find_program():
    """wavetank_run: the one that WAVETANK_RUN names, or that of the workspaces whose setup.bash was sourced."""
    candidates = [os.environ.get("WAVETANK_RUN")]
    candidates += [os.path.join(place, "lib", "wavetank", "wavetank_run") for place in os.environ.get("CMAKE_PREFIX_PATH", "").split(":") if place]
    for candidate in candidates + [shutil.which("wavetank_run")]:
        if candidate and os.access(candidate, os.X_OK):
            return candidate
    raise Failure("wavetank_run is not to be found: source setup.bash, or name it by WAVETANK_RUN")


def read_case(path):
    """The case's tree, as it is written. Raises Failure."""
    try:
        with open(path, encoding="utf-8") as file:
            tree = read_yaml(file)
    except OSError as error:
        raise Failure("the case '%s' cannot be read: %s" % (path, error.strerror))
    except (yaml.YAMLError, UnicodeDecodeError) as error:
        raise Failure("the case '%s' is not YAML: %s" % (path, " ".join(str(error).split())))
    if not isinstance(tree, dict):
        raise Failure("the case '%s' has no keys" % path)
    return tree


def named_files(tree):
    """(section, key) of every file that a case names."""
    if isinstance(tree, dict):
        for key, value in tree.items():
            if key in FILE_KEYS and isinstance(value, str):
                yield tree, key
            else:
                yield from named_files(value)
    elif isinstance(tree, list):
        for value in tree:
            yield from named_files(value)


def setting_tree(key, text):
    """What is set, below the last word of its key; without a value that is not YAML, which wavetank_run refuses."""
    try:
        return {key.split("/")[-1]: read_yaml(text)}
    except yaml.YAMLError:
        return {}


def local_path(name, case):
    """Where a file that a case names lies, or None for a shape and for what lies in a package."""
    if name.startswith("file://"):
        name = name[len("file://") :]
    elif "://" in name:
        return None
    return os.path.join(os.path.dirname(os.path.abspath(case)), name)


def digest(path):
    value = hashlib.sha256()
    with open(path, "rb") as file:
        for part in iter(lambda: file.read(1 << 20), b""):
            value.update(part)
    return value.hexdigest()


def version_of(program):
    try:
        return subprocess.run([program, "--version"], stdout=subprocess.PIPE, check=True, **TEXT).stdout.strip()
    except (OSError, subprocess.CalledProcessError) as error:
        raise Failure("'%s' does not run: %s" % (program, error))


def fingerprint(run, program_version):
    """What a finished run must have been made from to count for this one, by the words that tell which of it has changed."""
    tree = read_case(run.case)
    files = {}
    set_files = [named for key, text in run.settings for named in named_files(setting_tree(key, text))]
    for section, key in list(named_files(tree)) + set_files:
        path = local_path(section[key], run.case)
        if path and os.path.isfile(path):
            files[section[key]] = digest(path)
    return {
        "the case": digest(run.case),
        "files that the case names": files,
        "the settings": [list(setting) for setting in run.settings] + list(run.options),
        "the version of wavetank_run": program_version,
    }


class Runner:
    """Does runs in folders of `out`. again: what was made from something else is run anew; else that is a Failure. tell: takes a line for the user."""

    def __init__(self, out, again=False, tell=print):
        self.out, self._again, self._tell = out, again, tell
        self._program = find_program()
        self._version = version_of(self._program)
        try:
            os.makedirs(out, exist_ok=True)
        except OSError as error:
            raise Failure("cannot make the folder '%s': %s" % (out, error.strerror))

    def do(self, runs):
        """Results of the runs, in their order. All that cannot be taken over is found before the first run."""
        markers = [self._marker(run) for run in runs]
        results = []
        for number, (run, marker) in enumerate(zip(runs, markers), 1):
            head = "[%d/%d] %s" % (number, len(runs), run.name)
            folder = os.path.join(self.out, run.name)
            if marker:
                result = Result(run, folder, marker["exit_code"], marker["sentence"], marker["seconds"])
                self._tell("%s: done before%s" % (head, "" if result.exit_code == 0 else ", failed: " + result.sentence))
            else:
                self._tell("%s: running" % head)
                result = self._run(run, folder)
                self._tell("%s: %s" % (head, "%.1f s" % result.seconds if result.exit_code == 0 else "failed: " + result.sentence))
            sys.stdout.flush()
            results.append(result)
        return results

    def _marker(self, run):
        """Of a run that is finished already and was made from the same; else None."""
        path = os.path.join(self.out, run.name, MARKER)
        if not os.path.exists(path):
            return None
        try:
            with open(path, encoding="utf-8") as file:
                marker = json.load(file)
            made_from, _ = marker["made_from"], (marker["exit_code"], marker["sentence"], marker["seconds"])
        except (OSError, ValueError, KeyError, TypeError):
            return None  # of a run that was cut short
        wanted = fingerprint(run, self._version)
        changed = [what for what in wanted if made_from.get(what) != wanted[what]]
        if not changed:
            if marker["exit_code"] == 0 and not os.path.isfile(os.path.join(self.out, run.name, BAG)):
                return None  # its bag was removed
            return marker if marker["exit_code"] in (0, STOPPED_BY_WATCHDOG) else None
        sentence = "'%s' was run before, but not with the same of: %s" % (os.path.join(self.out, run.name), ", ".join(changed))
        if not self._again:
            raise Failure(sentence + "; --again runs it anew, another --out keeps both")
        self._tell(sentence + "; it is run anew")
        return None

    def _run(self, run, folder):
        made_from = fingerprint(run, self._version)
        os.makedirs(folder, exist_ok=True)
        for name in (MARKER, BAG):
            if os.path.lexists(os.path.join(folder, name)):
                os.remove(os.path.join(folder, name))
        command = [self._program, os.path.abspath(run.case), "--bag", os.path.abspath(os.path.join(folder, BAG))]
        for key, value in run.settings:
            command += ["--set", "%s=%s" % (key, value)]
        began = time.time()
        with open(os.path.join(folder, LOG), "w", encoding="utf-8") as log:
            # in a session of its own, so that Ctrl-C does not reach it by itself
            process = subprocess.Popen(command + run.options, stdout=log, stderr=subprocess.PIPE, start_new_session=True, **TEXT)
            try:
                complaints = process.communicate()[1]
            except BaseException:
                process.send_signal(signal.SIGINT)  # it ends after the step in progress, with a whole bag
                try:
                    process.communicate()
                except BaseException:  # such as a second Ctrl-C
                    process.kill()
                    process.wait()
                    raise
                raise
            log.write(complaints)
        if process.returncode in INTERRUPTED:
            raise KeyboardInterrupt
        result = Result(run, folder, process.returncode, sentence_of(complaints, process.returncode), time.time() - began)
        marker = {"made_from": made_from, "exit_code": result.exit_code, "sentence": result.sentence, "seconds": round(result.seconds, 3)}
        temporary = os.path.join(folder, MARKER + ".part")
        with open(temporary, "w", encoding="utf-8") as file:
            json.dump(marker, file, indent=1)
        os.replace(temporary, os.path.join(folder, MARKER))
        return result


def sentence_of(complaints, exit_code):
    if exit_code == 0:
        return ""
    lines = [line for line in complaints.splitlines() if line.strip() and ": warning: " not in line]
    return re.sub("^wavetank_run: ", "", lines[-1]) if lines else "wavetank_run ended with exit code %d" % exit_code


def numbers_of(text, what):
    """A list of numbers: a,b,c or FIRST:LAST:COUNT. Raises Failure."""
    try:
        if ":" in text:
            first, last, count = text.split(":")
            first, last, count = float(first), float(last), int(count)
            if count < 2:
                raise ValueError
            return [first + (last - first) * n / (count - 1) for n in range(count)]
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise Failure("%s '%s' are neither numbers with commas between nor FIRST:LAST:COUNT" % (what, text))
