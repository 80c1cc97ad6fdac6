// A sound for each verdict, and for what is refused. They differ in their course, not only in pitch.

const SOUNDS = {
  PASS: { wave: "sine", notes: [[660, 0.12], [990, 0.22]] },
  FAIL: { wave: "square", notes: [[330, 0.3], [165, 0.55]] },
  ERROR: { wave: "triangle", notes: [[520, 0.12], [0, 0.08], [520, 0.12], [0, 0.08], [520, 0.12]] },
};
const LOUD = 0.2;
let context;

export const isOn = () => localStorage.getItem("sound") !== "off";
export const turn = (on) => localStorage.setItem("sound", on ? "on" : "off");

export function play(name) {
  const sound = SOUNDS[name];
  if (!sound || !isOn()) return;
  context ??= new AudioContext();
  context.resume();
  let at = context.currentTime;
  for (const [pitch, seconds] of sound.notes) {
    if (pitch) note(sound.wave, pitch, at, seconds);
    at += seconds;
  }
}

function note(wave, pitch, at, seconds) {
  const tone = new OscillatorNode(context, { type: wave, frequency: pitch });
  const volume = new GainNode(context, { gain: LOUD });
  volume.gain.setTargetAtTime(0, at + seconds - 0.03, 0.01);
  tone.connect(volume).connect(context.destination);
  tone.start(at);
  tone.stop(at + seconds);
}
