"""A web server that records what is posted to it, and answers what FOLDER/answer says.
    server.py FOLDER [CERTIFICATE KEY]
Prints its port. FOLDER/answer has the status and the text of the next answers; a line for each request goes to FOLDER/requests.jsonl.
"""
import base64
import http.server
import json
import pathlib
import ssl
import sys

FOLDER = pathlib.Path(sys.argv[1])


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def do_POST(self):
        body = self.rfile.read(int(self.headers["Content-Length"]))
        told = {"path": self.path, "headers": {name.lower(): value for name, value in self.headers.items()},
                "body": base64.b64encode(body).decode()}
        with open(FOLDER / "requests.jsonl", "a") as out:
            out.write(json.dumps(told) + "\n")
        status, _, text = (FOLDER / "answer").read_text().partition(" ")
        self.send_response(int(status))
        if status.startswith("3"):
            self.send_header("Location", "/" + text)
        self.send_header("Content-Length", str(len(text.encode())))
        self.end_headers()
        self.wfile.write(text.encode())

    def log_message(self, *_):
        pass


server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
if len(sys.argv) > 2:
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(sys.argv[2], sys.argv[3])
    server.socket = context.wrap_socket(server.socket, server_side=True)
print(server.server_port, flush=True)
server.serve_forever()
