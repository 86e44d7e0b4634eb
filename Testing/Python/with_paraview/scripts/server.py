"""ParaView servers of several processes on this machine, for scripts that connect to them."""

import contextlib
import os
import socket
import subprocess

import session
from paraview import servermanager, simple


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


def start(port, processes):
    """Start the server's processes.

    They must not inherit MPI's variables, which say that MPI started this script.
    """
    environment = {
        k: v
        for k, v in os.environ.items()
        if "ALLOW_RUN" in k or not k.startswith(("OMPI_", "PMIX_"))
    }
    command = ["mpiexec", "--oversubscribe", "-n", str(processes)]
    return subprocess.Popen([*command, "pvserver", f"--server-port={port}"], env=environment)


@contextlib.contextmanager
def connected(processes):
    """Connect to a server with the plugin, which ends with the block."""
    port = free_port()
    server = start(port, processes)
    try:
        simple.Connect("localhost", port)  # tries for a minute
        session.load_plugin(remote=True)
        assert servermanager.ActiveConnection.GetNumberOfDataPartitions() == processes
        yield
    finally:
        server.terminate()
        server.wait()
