"use strict";
(() => {
  const COLOURS = {
    light: ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#b07800", "#3a8fc4", "#444444"],
    dark: ["#66b7e8", "#ff9a52", "#3fd0a4", "#eba6cc", "#f2bd45", "#9fd6f5", "#dddddd"],
  };
  const CONFIG = { responsive: true, displaylogo: false, modeBarButtonsToRemove: ["toImage"] };
  const SECONDS = 4; // of a playback, whatever time was simulated

  const isDark = () => {
    const chosen = document.documentElement.dataset.theme;
    return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  };
  const variable = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const faded = (hex, alpha) => {
    const [r, g, b] = [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
    return `rgba(${r}, ${g}, ${b}, ${alpha})`;
  };

  // ---- colours of the theme

  const themed = (layout) => {
    const [text, line] = [variable("--text"), variable("--line")];
    const axis = { gridcolor: line, zerolinecolor: line, linecolor: line, automargin: true };
    const found = { ...layout, paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", font: { color: text, family: "system-ui, sans-serif" } };
    for (const key of Object.keys(found)) {
      if (/^[xy]axis/.test(key)) found[key] = { ...axis, ...found[key] };
    }
    if (found.scene) {
      found.scene = { ...found.scene };
      for (const key of ["xaxis", "yaxis", "zaxis"]) {
        found.scene[key] = { ...found.scene[key], gridcolor: line, zerolinecolor: line, backgroundcolor: "rgba(0,0,0,0)", color: text };
      }
    }
    return found;
  };

  const painted = (trace) => {
    if (trace.meta === undefined || trace.meta.colour === undefined) return trace;
    const palette = COLOURS[isDark() ? "dark" : "light"];
    const colour = palette[trace.meta.colour % palette.length];
    const found = { ...trace, line: { ...trace.line, color: colour }, marker: { ...trace.marker, color: colour } };
    if (trace.fill || trace.type === "box") found.fillcolor = faded(colour, 0.2);
    return found;
  };

  const redrawn = [];
  const onTheme = (redraw) => { redrawn.push(redraw); };
  const redrawAll = () => redrawn.forEach((redraw) => redraw());
  document.querySelector(".theme").addEventListener("click", () => {
    document.documentElement.dataset.theme = isDark() ? "light" : "dark";
    redrawAll();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redrawAll);

  const sourceOf = (element) => JSON.parse(document.getElementById(element.dataset.source).textContent);

  // ---- charts

  const drawChart = (element) => {
    const figure = sourceOf(element);
    const draw = () => Plotly.react(element, figure.data.map(painted), themed(figure.layout), CONFIG);
    draw();
    onTheme(draw);
  };

  // ---- the moving body

  const decoded = (text, kind) => new kind(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer);

  const partOf = (given) => {
    const faces = given.faces, seen = new Set(), edges = [];
    for (const face of faces) {
      face.forEach((start, corner) => {
        const end = face[(corner + 1) % 4], name = start < end ? `${start} ${end}` : `${end} ${start}`;
        if (!seen.has(name)) { seen.add(name); edges.push(start, end); }
      });
    }
    return { ...given, rest: decoded(given.rest, Float32Array), moves: decoded(given.moves, Int16Array), edges };
  };

  // Coordinates of all vertices at a place between two frames, with their displacements exaggerated.
  const placed = (part, frame, scale, step) => {
    const count = part.rest.length, low = Math.floor(frame), share = frame - low;
    const high = Math.min(low + 1, part.moves.length / count - 1), factor = scale * step;
    const found = [0, 1, 2].map(() => new Float32Array(count / 3));
    for (let at = 0; at < count; at += 1) {
      const moved = (1 - share) * part.moves[low * count + at] + share * part.moves[high * count + at];
      found[at % 3][(at / 3) | 0] = part.rest[at] + factor * moved;
    }
    return found;
  };

  const edgesOf = (part, coordinates) => coordinates.map((values) => {
    const found = [];
    for (let at = 0; at < part.edges.length; at += 2) found.push(values[part.edges[at]], values[part.edges[at + 1]], null);
    return found;
  });

  const meshOf = (part) => ({
    type: "mesh3d", name: part.name, color: part.colour, opacity: part.opacity, showlegend: true, hoverinfo: "skip",
    flatshading: true, lighting: { ambient: 0.75, diffuse: 0.35, specular: 0, roughness: 1, fresnel: 0, facenormalsepsilon: 0 },
    lightposition: { x: 2000, y: -4000, z: 6000 },
    i: part.faces.flatMap(([a]) => [a, a]), j: part.faces.flatMap(([, b, c]) => [b, c]), k: part.faces.flatMap(([, , c, d]) => [c, d]),
    legendgroup: part.name,
  });
  const linesOf = (part) => ({
    type: "scatter3d", mode: "lines", legendgroup: part.name, showlegend: false, hoverinfo: "skip",
    line: { color: "rgba(0, 0, 0, 0.6)", width: 1.5 },
  });

  const setUpMotion = (element) => {
    const given = sourceOf(element);
    const find = (name) => element.querySelector(name);
    const [body, chart, play, time, exaggeration] = [".body", ".trace", ".play", ".time", ".exaggeration"].map(find);
    const parts = given.parts.map(partOf), opaque = parts.filter((part) => part.opacity === 1);
    const last = given.times.length - 1, track = given.track;
    let frame = 0, scale = given.exaggeration, playing = 0;

    const along = (values, at) => {
      const low = Math.floor(at), high = Math.min(low + 1, last);
      return values[low] + (at - low) * (values[high] - values[low]);
    };
    const path = (axis) => {
      const values = track.positions.map((position) => position[axis]);
      const until = [...values.slice(0, Math.floor(frame) + 1), along(values, frame)];
      return until.map((value) => values[0] + scale * (value - values[0]));
    };
    const ranges = () => [0, 1, 2].map((axis) => {
      const [low, high, down, up] = given.bounds[axis];
      return [low + scale * down, high + scale * up];
    });
    const coordinates = () => {
      const at = parts.map((part) => placed(part, frame, scale, given.step));
      const edges = opaque.map((part) => edgesOf(part, at[parts.indexOf(part)]));
      const trace = track ? [[0, 1, 2].map(path)] : [];
      return [...at, ...edges, ...trace];
    };
    const traces = () => {
      const tip = track ? [{
        type: "scatter3d", mode: "lines+markers", name: `trace of the ${track.name}`, hoverinfo: "skip",
        line: { color: variable("--text"), width: 5 }, marker: { size: 2, color: variable("--text") },
      }] : [];
      const found = [...parts.map(meshOf), ...opaque.map(linesOf), ...tip], at = coordinates();
      found.forEach((one, number) => { [one.x, one.y, one.z] = at[number]; });
      return found;
    };
    const layout = () => {
      const away = Math.max(1, (1.75 * body.clientHeight) / body.clientWidth); // a narrow view shows less of it
      const eye = { x: 0.75 * away, y: -1.3 * away, z: 0.55 * away };
      const scene = { aspectmode: "data", uirevision: "kept", camera: { eye, center: { x: 0, y: 0, z: -0.1 } } };
      ranges().forEach((range, axis) => { scene[`${"xyz"[axis]}axis`] = { range, title: { text: `${"xyz"[axis]} (m)` }, nticks: 5 }; });
      return themed({ scene, margin: { l: 0, r: 0, t: 0, b: 0 }, legend: { orientation: "h", y: 0 }, uirevision: "kept" });
    };
    // Its value is the number of a frame, which nobody wants to hear.
    const say = (slider, beside, text) => { beside.textContent = text; slider.setAttribute("aria-valuetext", text); };
    const tell = () => {
      time.value = frame;
      say(time, find(".told"), `${along(given.times, frame).toFixed(4)} s`);
      say(exaggeration, find(".times"), `× ${scale}`);
    };
    const now = () => {
      const at = along(given.times, frame);
      return [{ type: "line", x0: at, x1: at, yref: "paper", y0: 0, y1: 1, line: { color: variable("--muted"), width: 1 } }];
    };
    const drawTrace = () => {
      if (!track) { chart.remove(); return; }
      const data = [0, 1, 2].map((axis) => painted({
        type: "scatter", mode: "lines", name: "xyz"[axis], x: given.times, meta: { colour: axis },
        y: track.positions.map((position) => 1000 * (position[axis] - track.positions[0][axis])),
        line: { dash: ["dot", "dash", "solid"][axis] }, hovertemplate: "%{y:.4f} mm at %{x:.4f} s",
      }));
      const title = { text: `${track.name} (mm)` };
      Plotly.react(chart, data, themed({
        xaxis: { title: { text: "time (s)" } }, yaxis: { title }, shapes: now(), margin: { l: 56, r: 8, t: 8, b: 40 },
        legend: { orientation: "h", y: 1.15 }, showlegend: true,
      }), CONFIG);
    };
    const draw = () => { Plotly.react(body, traces(), layout(), CONFIG); drawTrace(); tell(); };
    const move = () => {
      const at = coordinates();
      const all = (axis) => at.map((one) => one[axis]);
      Plotly.restyle(body, { x: all(0), y: all(1), z: all(2) });
      if (track) Plotly.relayout(chart, { shapes: now() });
      tell();
    };
    const stop = () => { cancelAnimationFrame(playing); playing = 0; play.textContent = "play"; };
    const start = () => {
      let before; // the moment of the first picture, which may be before now
      const advance = (moment) => {
        before ??= moment;
        frame = (frame + ((moment - before) / 1000) * (last / SECONDS)) % last;
        before = moment;
        move();
        playing = requestAnimationFrame(advance);
      };
      playing = requestAnimationFrame(advance);
      play.textContent = "pause";
    };

    time.max = last;
    exaggeration.max = given.most;
    exaggeration.value = scale;
    play.disabled = last === 0;
    play.addEventListener("click", () => (playing ? stop() : start()));
    time.addEventListener("input", () => { stop(); frame = Number(time.value); move(); });
    exaggeration.addEventListener("input", () => { scale = Number(exaggeration.value); draw(); });
    draw();
    onTheme(draw);
  };

  // ---- all that is on the page, when it comes into view

  const watch = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target } of entries) {
      if (!isIntersecting) continue;
      watch.unobserve(target);
      (target.classList.contains("motion") ? setUpMotion : drawChart)(target);
    }
  }, { rootMargin: "400px" });
  document.querySelectorAll(".chart, .motion").forEach((element) => watch.observe(element));
})();
