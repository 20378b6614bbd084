// Recordings: frames that were kept as they came, made into a file by the server of this page.

// Returns the file's bytes; `opened` and `frames` are messages as they came from the server.
export function convert(format, opened, frames) {
  return new Promise((resolve, reject) => {
    const socket = new WebSocket(`ws://${location.host}/page/convert/${format}`);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      for (const message of [opened, ...frames, new Uint8Array()]) socket.send(message);
    };
    socket.onmessage = (event) => resolve(new Blob([event.data]));
    socket.onclose = (event) => reject(new Error(event.reason || `closed with ${event.code}`));
  });
}

// Offers a file for download.
export function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
