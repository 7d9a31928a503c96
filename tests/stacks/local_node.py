"""local_node.py PORT EDS NODE: python-canopen's LocalNode behind slcan over TCP."""
import socket, sys, threading, time
import can, canopen

port, eds, node = int(sys.argv[1]), sys.argv[2], int(sys.argv[3])
bus_a = can.Bus(interface="virtual", channel="v", receive_own_messages=False)
network = canopen.Network(); network.bus = bus_a
notifier = can.Notifier(bus_a, network.listeners, timeout=0.01)
network.notifier = notifier
local = canopen.LocalNode(node, eds)
network.add_node(local)
bus_b = can.Bus(interface="virtual", channel="v")
srv = socket.create_server(("127.0.0.1", port))
local.nmt.send_command(0)
while True:
    c, _ = srv.accept()
    c.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    alive = True
    def tx():
        while alive:
            m = bus_b.recv(0.05)
            if m is None: continue
            if m.is_remote_frame: s = f"r{m.arbitration_id:03X}{m.dlc}\r"
            else: s = f"t{m.arbitration_id:03X}{m.dlc}{bytes(m.data).hex().upper()}\r"
            try: c.sendall(s.encode())
            except OSError: return
    t = threading.Thread(target=tx, daemon=True); t.start()
    b = b""
    while True:
        try: d = c.recv(4096)
        except OSError: break
        if not d: break
        *ls, b = (b + d).split(b"\r")
        for l in ls:
            k = l[:1]
            if k == b"t":
                n = int(l[4:5]); i = int(l[1:4], 16)
                bus_b.send(can.Message(arbitration_id=i, data=bytes.fromhex(l[5:5+2*n].decode()), is_extended_id=False)); c.sendall(b"z\r")
            elif k == b"r":
                bus_b.send(can.Message(arbitration_id=int(l[1:4],16), is_remote_frame=True, dlc=int(l[4:5] or b"0"), is_extended_id=False)); c.sendall(b"z\r")
            elif k == b"V": c.sendall(b"V1013\r")
            elif k == b"N": c.sendall(b"N0001\r")
            elif k == b"F": c.sendall(b"F00\r")
            else: c.sendall(b"\r")
    alive = False
