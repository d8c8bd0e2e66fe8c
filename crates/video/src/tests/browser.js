// Goes to 0.75 s of a video whose first frame is black, draws it as soon as it is there, and posts its size, its
// length, and the middle of each patch, of which the fourth is white.
const post = (text) => fetch("/", { method: "POST", body: text });
const video = document.createElement("video");
const canvas = document.createElement("canvas");

function look() {
    canvas.width = video.videoWidth;
    canvas.height = video.videoHeight;
    const context = canvas.getContext("2d");
    context.drawImage(video, 0, 0);
    const at = (x) => Array.from(context.getImageData(x, canvas.height / 2, 1, 1).data.slice(0, 3));
    if (at(3.5 * PATCH)[0] === 0) {
        setTimeout(look, 50);
        return;
    }
    const lines = [`${video.videoWidth} × ${video.videoHeight}, ${video.duration} s`];
    for (let x = PATCH / 2; x < canvas.width; x += PATCH) {
        lines.push(at(x).join(" "));
    }
    post(lines.join("\n"));
}

if (video.canPlayType('video/mp4; codecs="avc1.42E01E"') === "") {
    post("no H.264");
} else {
    video.muted = true;
    video.onerror = () => post("error: " + video.error.message + "\n");
    video.onloadeddata = () => { video.currentTime = 0.75; };
    video.onseeked = look;
    video.src = URL.createObjectURL(new Blob([new Uint8Array([BYTES])], { type: "video/mp4" }));
}
