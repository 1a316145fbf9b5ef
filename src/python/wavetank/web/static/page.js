/* The page: its connection, its buttons, and what comes. */
"use strict";

const PHASES = ["starting", "running", "paused", "finished", "failed"];
const RETRY = 1500, PUSH_EVERY = 100;  // ms
const WATERS = { particles: "all particles", free_surface: "particles of the surface", surface: "surface" };
const find = (id) => document.getElementById(id);

class Page {
  constructor() {
    this.view = this._makeView();
    this.plots = new Plots(find("plots"), find("boxes"), find("choice"), find("no_plots"));
    this.hello = null;
    this.status = null;
    this.paused = false;
    this.time = null;
    this.start = 0;  // s, of the ROS time that pictures of a tank have, where its time 0 is: a reset sets it on
    this.unseen = 0;  // pictures that the server is to be told of when they are drawn
    this.player = { time: 0, playing: false, waiting: false, asked: null };
    this._listen();
    this._connect();
    requestAnimationFrame((now) => this._play(now, now));
  }

  _makeView() {
    try {
      const view = new View(find("canvas"));
      find("ramp").style.background = `linear-gradient(to right, ${SPEED_COLOURS.join(", ")})`;
      view.onColours = (greatest) => {
        find("tick1").textContent = figures(greatest / 2);
        find("tick2").textContent = figures(greatest) + (view.top > greatest * 1.001 ? " +" : "");
      };
      return view;
    } catch (error) {
      this.broken = true;
      notice("This browser has no WebGL, so the tank cannot be drawn; the plots can.");
      const nothing = () => {};
      return new Proxy({}, { get: () => nothing, set: () => true });
    }
  }

  // ---------------------------------------------------------------- connection

  _connect() {
    this._badge("wait", "connecting");
    const socket = new WebSocket(`ws://${location.host}/socket`);
    socket.binaryType = "arraybuffer";
    socket.onmessage = (event) => this._hear(event.data);
    socket.onclose = (event) => {
      this.socket = null;
      this.player.waiting = false;
      this._enable();
      this._badge("bad", event.code === 1013 ? "full" : "not connected");
      answer(event.code === 1013 ? `${event.reason}: close one of them.` : "The server does not answer; trying again.", true);
      this.lost = true;
      setTimeout(() => this._connect(), RETRY);
    };
    socket.onopen = () => {
      this.socket = socket;
      this.unseen = 0;
    };
  }

  send(request) {
    if (this.socket && this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(request));
  }

  /** What cannot be read or shown is told, and counts as seen: the server sends the next only when it hears of that. */
  _hear(data) {
    let packet = null;
    try {
      packet = typeof data === "string" ? JSON.parse(data) : unpack(data);
      const take = this["_take_" + packet.kind];
      if (take) take.call(this, packet);
    } catch (error) {
      console.error(`${packet ? packet.kind : "a message"}: ${error.stack}`);
      this.player.waiting = false;
      answer(`What came of the server cannot be shown (${packet ? packet.kind : "a message"}): ${error.message}.`, true);
    } finally {
      if (!packet || (packet.kind !== "answer" && packet.kind !== "series")) this.unseen += 1;
    }
  }

  _take_hello(packet) {
    if (this.lost || (this.hello && this.hello.run !== packet.run)) {  // what was sent before the connection broke comes again, of another tank nothing does
      this.plots.clear();
      this.view.forget();
      this.status = this.time = null;
      this.what = undefined;
      answer("");
      this.lost = false;
    }
    const first = !this.hello || this.hello.mode !== packet.mode;
    this.hello = packet;
    this.replay = packet.mode === "replay";
    find("title").textContent = packet.title || packet.source;
    document.title = (packet.title || packet.source) + " – wavetank";
    if (this.view.dimensions !== packet.dimensions) {
      this.view.dimensions = packet.dimensions;
      this.view.look("home");
    }
    this.view.spacing = packet.spacing;
    this._listWaters(packet.waters);
    this._listBodies(packet.bodies);
    find("player").hidden = !this.replay;
    if (this.replay) this._openBag(packet.times, first);
    else this.send({ do: "show", water: find("water").value });
    this._enable();
    this._showState();
  }

  _take_drawing(packet) { this.view.draw(packet); }

  _take_lines(packet) { this.view.drawLines(packet); }

  _take_cloud(packet) {
    this.player.waiting = false;
    if (packet.water !== find("water").value) return;
    this.view.showCloud(packet);
    const every = packet.points.length / 4 / this.view.count;
    this._arrived(packet, `${packet.points.length / 4} particles` + (every > 1.5 ? `, one in ${Math.round(every)} drawn` : ""));
    find("legend").hidden = false;
  }

  _take_surface(packet) {
    this.player.waiting = false;
    if (find("water").value !== "surface") return;
    this.view.showSurface(packet);
    this._arrived(packet, `${packet.corners.length / 3} triangles`);
    find("legend").hidden = true;
  }

  _take_spray(packet) {
    if (find("water").value === "surface") this.view.showSpray(packet);
  }

  _arrived(packet, what) {
    this.received = (this.received || 0) + 1;
    this.what = what;
    this._setTime(packet.time - this.start, packet.values);
    if (!this.broken) notice("");
    this._showFacts();
  }

  _take_poses(packet) { this.view.placeBodies(packet.poses); }

  _take_series(packet) { this.plots.add(packet); }

  _take_status(packet) {
    this.status = packet;
    this.paused = Boolean(packet.paused);
    const start = Math.round(packet.stamp - packet.time);
    if (start !== this.start || packet.time > (this.time || 0) || this.what === undefined) {
      this.start = start;
      this._setTime(packet.time);
    }
    if (packet.failure) answer(packet.failure, true);
    this._showState();
    this._showFacts();
    this._enable();
  }

  _take_silence(packet) {
    this.silence = packet;
    this._showState();
    this._enable();
  }

  _take_answer(packet) {
    if (!packet.ok) {
      this.player.waiting = false;
      answer(packet.text, true);
    } else if (packet.do !== "frame" && packet.do !== "show" && packet.do !== "push") {
      answer(packet.text && packet.text !== "success" ? packet.text : "", false);
      if (packet.do === "pause") this._enable();
    }
    this.answered = packet;
  }

  // ---------------------------------------------------------------- what is shown

  _badge(kind, text) {
    find("state").className = "badge " + kind;
    find("state").textContent = text;
  }

  _showState() {
    if (!this.socket || !this.hello) return;
    if (this.replay) {
      this._badge("good", "bag");
      return;
    }
    const silent = this.silence && this.silence.silent;
    if (this.silence && !this.silence.master) this._badge("bad", "no ROS master");
    else if (!this.status || silent) this._badge("wait", `waiting for ${this.hello.tank}`);
    else this._badge(this.status.phase === 4 ? "bad" : this.status.phase === 0 ? "wait" : "good", PHASES[this.status.phase] || "running");
    if (!this.broken && this.what === undefined)
      notice(!this.status || silent ? `Waiting for the tank ${this.hello.tank}.` : this.status.phase === 0 ? `Starting: ${Math.round(100 * this.status.start_progress)} %` : "");
  }

  _showFacts() {
    const facts = this.what ? [this.what] : [];
    const status = this.status;
    if (status && status.phase === 1 && status.real_time_factor) facts.push(`${figures(status.real_time_factor)} × real time`, `${figures(status.steps_per_second)} steps/s`);
    find("facts").textContent = facts.join(" · ");
  }

  /** values: of a bag, by instrument, what it measured last. */
  _setTime(time, values) {
    this.time = time;
    find("clock").textContent = `t = ${time.toFixed(3)} s`;
    if (!this.replay) return;
    this.plots.setTime(time, values || {});
    if (this.player.playing) find("slider").value = time;  // with the pictures: each change of the page is drawn
  }

  _enable() {
    const alive = Boolean(this.socket && this.hello) && (this.replay || Boolean(this.status && !(this.silence && this.silence.silent)));
    const stands = this.replay ? !this.player.playing : this.paused;
    find("pause").disabled = find("reset").disabled = !alive;
    find("step").disabled = !alive || !stands;
    find("pause").textContent = stands ? (this.replay ? "Play" : "Continue") : "Pause";
    for (const button of document.querySelectorAll("#pushes button")) button.disabled = !alive;
    if (!alive && this.endPush) this.endPush();
  }

  _listWaters(waters) {
    const select = find("water"), before = select.value;
    select.replaceChildren(...waters.map((name) => new Option(WATERS[name] || name, name)));
    if (waters.includes(before)) select.value = before;
    select.disabled = waters.length < 2;
  }

  _listBodies(bodies) {
    const select = find("body"), before = select.value;
    this.bodies = bodies;
    select.replaceChildren(...bodies.map((body) => new Option(body.name, body.name)));
    if (bodies.some((body) => body.name === before)) select.value = before;
    else this._proposeForce();
    find("pusher").hidden = !bodies.length;
    for (const button of document.querySelectorAll("#pushes button")) button.hidden = this.hello.dimensions === 2 && /^0 -?1 0$/.test(button.dataset.push);
  }

  /** A twentieth of its weight, rounded. */
  _proposeForce() {
    const body = this.bodies.find((each) => each.name === find("body").value);
    if (body) find("force").value = body.mass ? roundUp(body.mass * 9.81 / 20) : 1;
  }

  // ---------------------------------------------------------------- a bag

  _openBag(times, first) {
    const slider = find("slider");
    slider.min = times[0];
    slider.max = times[times.length - 1];
    if (first) {
      this.player.time = times[0];
      this.player.playing = times.length > 1;
    }
    this.player.asked = null;
    this._ask();
  }

  /** Asks for the picture of the player's time, when the one before has come and it is another one. */
  _ask() {
    const times = this.hello.times, player = this.player;
    let low = 0, high = times.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (times[middle] <= player.time + 1e-9) low = middle; else high = middle - 1;
    }
    player.index = low;
    const wanted = times[low] + " " + find("water").value;
    if (player.waiting || player.asked === wanted || !this.socket) return;
    player.asked = wanted;
    player.waiting = true;
    this.send({ do: "frame", time: times[low], water: find("water").value });
  }

  _play(before, now) {
    for (; this.unseen > 0; --this.unseen) this.send({ do: "seen" });
    if (this.replay && this.hello) {
      const player = this.player, end = this.hello.times[this.hello.times.length - 1];
      if (player.playing) {
        player.time += Math.min(now - before, 250) / 1000 * Number(find("speed").value);
        if (player.time >= end) {
          player.time = end;
          player.playing = false;
          this._enable();
        }
      }
      this._ask();
    }
    requestAnimationFrame((next) => this._play(now, next));
  }

  _goTo(time, playing) {
    this.player.time = time;
    this.player.playing = playing;
    find("slider").value = time;
    this._ask();
    this._enable();
  }

  // ---------------------------------------------------------------- buttons

  pause() {
    if (find("pause").disabled) return;
    if (this.replay) {
      const times = this.hello.times, atEnd = this.player.time >= times[times.length - 1];
      this._goTo(!this.player.playing && atEnd ? times[0] : this.player.time, !this.player.playing);
      return;
    }
    this.paused = !this.paused;
    this.send({ do: "pause", value: this.paused });
    this._enable();
  }

  step() {
    if (find("step").disabled) return;
    if (this.replay) this._goTo(this.hello.times[Math.min(this.player.index + 1, this.hello.times.length - 1)], false);
    else this.send({ do: "step" });
  }

  reset() {
    if (this.replay) this._goTo(this.hello.times[0], false);
    else this.send({ do: "reset" });
  }

  push(direction) {
    const force = Number(find("force").value);
    if (!Number.isFinite(force)) return;
    this.send({ do: "push", body: find("body").value, force: direction.map((part) => part * force), torque: [0, 0, 0] });
  }

  _holdToPush(button) {
    const direction = button.dataset.push.split(" ").map(Number);
    let timer = null;
    const end = () => {
      if (!timer) return;
      clearInterval(timer);
      timer = this.endPush = null;
      button.classList.remove("held");
      this.push([0, 0, 0]);
    };
    const begin = (event) => {
      event.preventDefault();
      if (button.disabled || timer) return;
      if (this.endPush) this.endPush();
      this.endPush = end;
      button.classList.add("held");
      this.push(direction);
      timer = setInterval(() => (button.disabled || button.hidden ? end() : this.push(direction)), PUSH_EVERY);
    };
    button.addEventListener("pointerdown", begin);
    for (const name of ["pointerleave", "blur"]) button.addEventListener(name, end);
    for (const name of ["pointerup", "pointercancel", "blur", "keyup"]) window.addEventListener(name, end);  // a button that is disabled meanwhile hears of none
    button.addEventListener("keydown", (event) => { if ((event.key === " " || event.key === "Enter") && !event.repeat) begin(event); });
  }

  _listen() {
    for (const name of ["pause", "step", "reset"]) find(name).addEventListener("click", () => this[name]());
    for (const button of document.querySelectorAll("[data-view]")) button.addEventListener("click", () => this.view.look(button.dataset.view));
    document.querySelectorAll("#pushes button").forEach((button) => this._holdToPush(button));
    find("names").addEventListener("change", (event) => this.view.setNames(event.target.checked));
    find("body").addEventListener("change", () => this._proposeForce());
    find("range").addEventListener("input", (event) => {
      const value = Number(event.target.value);
      this.view.range = value > 0 ? value : null;
      this.view.setColours();
    });
    find("slider").addEventListener("input", (event) => this._goTo(Number(event.target.value), false));
    find("water").addEventListener("change", () => {
      this.view.hideWater();
      if (this.replay) this._ask();
      else this.send({ do: "show", water: find("water").value });
    });
    document.addEventListener("keydown", (event) => {
      if (/^(INPUT|SELECT|BUTTON|SUMMARY)$/.test(event.target.tagName) || event.ctrlKey || event.altKey || event.metaKey) return;
      const done = { " ": () => this.pause(), ".": () => this.step(), "0": () => this.view.look("home") }[event.key];
      if (done) {
        event.preventDefault();
        done();
      }
    });
  }
}

function notice(text) {
  find("notice").textContent = text;
  find("notice").hidden = !text;
}

let answerTimer = null;

/** Shown for some seconds. */
function answer(text, bad) {
  find("answer").textContent = text;
  find("answer").style.color = bad ? "" : "#9db0c2";
  clearTimeout(answerTimer);
  if (text) answerTimer = setTimeout(() => { find("answer").textContent = ""; }, 8000);
}

window.addEventListener("load", () => { window.wavetank = new Page(); });
