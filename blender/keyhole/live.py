"""Receives pictures while they are made, by the protocol of tev (https://github.com/Tom94/tev)."""

import socket
import struct
import threading

import numpy as np

UPDATE_IMAGE = 6


def receive(connection, size):
    data = bytearray()
    while len(data) < size:
        part = connection.recv(size - len(data))
        if not part:
            raise EOFError
        data += part
    return bytes(data)


def decode(packet):
    """{"R": array (height, width), ...} of a packet with a whole picture; None for packets of other kinds."""
    if packet[0] != UPDATE_IMAGE:
        return None
    at = packet.index(0, 2) + 1  # behind the picture's name
    count, = struct.unpack_from("<i", packet, at)
    at += 4
    names = []
    for _ in range(count):
        end = packet.index(0, at)
        names.append(packet[at:end].decode())
        at = end + 1
    _, _, width, height = struct.unpack_from("<4i", packet, at)
    at += 16 + 16 * count  # the bounds, then an offset and a stride for each channel
    pixels = np.frombuffer(packet, "<f4", width * height * count, at).reshape(height, width, count)
    return {name: pixels[:, :, k] for k, name in enumerate(names)}


class LiveView:
    """Listens at `address`, and keeps the newest picture."""

    def __init__(self):
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.address = "127.0.0.1:%d" % self.listener.getsockname()[1]
        self.newest = None
        threading.Thread(target=self.listen, daemon=True).start()

    def listen(self):
        try:
            connection, _ = self.listener.accept()
            with connection:
                while True:
                    size, = struct.unpack("<I", receive(connection, 4))
                    picture = decode(receive(connection, size - 4))
                    if picture is not None:
                        self.newest = picture
        except (EOFError, OSError):
            pass  # the render is over

    def take(self):
        """The newest picture, once; None if there is no new one."""
        picture, self.newest = self.newest, None
        return picture

    def close(self):
        self.listener.shutdown(socket.SHUT_RDWR)  # wakes the thread if nobody came
        self.listener.close()
