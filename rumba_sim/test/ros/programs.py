"""Nodes that tests start: each from a process that has loaded the libraries, which is several times as fast.

What runs is the installed script, as the main program of a process of its own, with the arguments, environment, folder
and files that Popen is given; this process is its parent, so that the exit code is the node's own. Only LIBRARIES are
loaded before: neither rospy, which reads the arguments when it is imported, nor anything that imports it. The tests
that start a node by rosrun or roslaunch load all of it each time, as users do.
"""

import array
import ctypes
import functools
import gc
import importlib
import json
import os
import runpy
import socket
import subprocess
import sys

PR_SET_CHILD_SUBREAPER = 36  # prctl(2): a process whose parent has ended becomes a child of this one
LARGEST = 1 << 17  # [bytes] of a request
# Modules to load; test modules add theirs before they start a node. The main of a warm_up is called too.
LIBRARIES = [
    'diagnostic_msgs.msg', 'geometry_msgs.msg', 'nav_msgs.msg', 'nav_msgs.srv', 'PIL.Image', 'rosgraph',
    'rosgraph_msgs.msg', 'rumba_msg.msg', 'rumba_msg.srv', 'rumba_sim.model.maps.map_file',
    'rumba_sim.model.simulation.guided_world', 'rumba_sim.model.simulation.world_state', 'rumba_sim.model.warm_up',
    'scipy.ndimage', 'sensor_msgs.msg', 'std_srvs.srv', 'tf2_msgs.msg', 'visualization_msgs.msg', 'xmlrpc.server',
    'yaml']


@functools.lru_cache(maxsize=None)
def executable(package, node):
    """Path of a node, which `rosrun` would look for at each start, longer than some nodes take to start."""
    import roslib.packages  # programs that are no nodes need no ROS
    return roslib.packages.find_node(package, node)[0]


def start(package, node, *arguments, **options):
    """Start a node; `options` are those of Popen that concern its environment, its folder and its files."""
    return start_script(executable(package, node), *arguments, **options)


def start_script(path, *arguments, libraries=LIBRARIES, **options):
    """Start a program, in the same way if it is in Python; `libraries` are loaded before."""
    with open(path, 'rb') as file:
        is_script = file.read(2) == b'#!'
    if not is_script:
        return subprocess.Popen([str(path), *arguments], **options)
    return _Program(_nursery(tuple(libraries)), [str(path), *arguments], **options)


def run(package, node, *arguments, timeout, **options):
    """Run a node to its end; returns it as subprocess.run does."""
    with start(package, node, *arguments, **options) as process:
        try:
            output, errors = process.communicate(timeout=timeout)
        except subprocess.TimeoutExpired:
            process.kill()
            raise
        return subprocess.CompletedProcess(process.args, process.returncode, output, errors)


class _Program(subprocess.Popen):
    """A process that a nursery makes instead of this one."""

    def __init__(self, nursery, arguments, **options):
        self._nursery = nursery
        super().__init__(arguments, **options)

    def _execute_child(self, args, _executable, _preexec_fn, _close_fds, _pass_fds, cwd, env, _startupinfo,
                       _creationflags, _shell, p2cread, p2cwrite, c2pread, c2pwrite, errread, errwrite, *_):
        files = [given if given != -1 else usual for usual, given in enumerate((p2cread, c2pwrite, errwrite))]
        request = {'arguments': args, 'folder': os.fspath(cwd or os.getcwd()),
                   'environment': dict(os.environ if env is None else env)}
        self.pid = self._nursery.make(request, files)
        self._child_created = True
        for ours, theirs in ((p2cwrite, p2cread), (c2pread, c2pwrite), (errread, errwrite)):
            if ours != -1:
                os.close(theirs)
        if hasattr(self, '_devnull'):
            os.close(self._devnull)


@functools.lru_cache(maxsize=None)
def _nursery(libraries):
    return _Nursery(libraries)


class _Nursery:
    """The process that has loaded the libraries; it ends with this one."""

    def __init__(self, libraries):
        ctypes.CDLL(None).prctl(PR_SET_CHILD_SUBREAPER, 1)
        self._channel, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            for end in (self._channel, theirs):
                end.setblocking(True)  # whatever the usual timeout of this process is
            subprocess.Popen([sys.executable, __file__, str(theirs.fileno()), *libraries], pass_fds=[theirs.fileno()])

    def make(self, request, files):
        """Have it make a process with these files as its first; returns its number."""
        rights = [(socket.SOL_SOCKET, socket.SCM_RIGHTS, array.array('i', files))]
        self._channel.sendmsg([json.dumps(request).encode()], rights)
        return int(self._channel.recv(LARGEST))


def _serve(channel):
    """In the nursery: make the processes that are asked for. In each of these: return what was asked for."""
    size = array.array('i').itemsize
    while True:
        request, rights, _, _ = channel.recvmsg(LARGEST, socket.CMSG_SPACE(3 * size))
        if not request:
            sys.exit()  # the test has ended
        files = array.array('i', rights[0][2][:3 * size])
        read, write = os.pipe()
        between = os.fork()
        if between == 0:
            node = os.fork()
            if node != 0:
                os.write(write, str(node).encode())
                os._exit(0)  # so that the process of the test becomes the parent
            for usual, file in enumerate(files):
                os.dup2(file, usual)
            channel.close()
            for file in {*files, read, write}:
                os.close(file)
            return json.loads(request)
        os.waitpid(between, 0)
        channel.send(os.read(read, LARGEST))
        for file in {*files, read, write}:
            os.close(file)


def _python_path():
    return os.environ.get('PYTHONPATH', '').split(os.pathsep)


def _main():
    channel = socket.socket(fileno=int(sys.argv[1]))
    usual = [folder for folder in sys.path[1:] if folder not in _python_path()]
    for name in sys.argv[2:]:
        module = importlib.import_module(name)
        if name.endswith('.warm_up'):
            module.main()
    gc.collect()
    gc.freeze()  # otherwise each node would look through all objects of the libraries, and copy their memory, to end
    request = _serve(channel)
    os.chdir(request['folder'])
    os.environ.clear()
    os.environ.update(request['environment'])
    sys.argv[:] = request['arguments']
    sys.path[:] = [os.path.dirname(sys.argv[0]), *_python_path(), *usual]
    runpy.run_path(sys.argv[0], run_name='__main__')


if __name__ == '__main__':
    _main()
