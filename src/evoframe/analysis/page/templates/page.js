"use strict";
(() => {
  const COLORS = {
    light: ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#b07800", "#3a8fc4", "#444444"],
    dark: ["#66b7e8", "#ff9a52", "#3fd0a4", "#eba6cc", "#f2bd45", "#9fd6f5", "#dddddd"],
  };
  const SECONDS = 4; // of a playback, regardless of the simulated time
  const PAPER = { width: 640, chart: 300, body: 320, trace: 230 }; // px, of what is printed: fits A4 and Letter
  const MM = 1000; // the data are in meters, the page is in millimeters
  // The toolbar of plotly covers data unless the chart is wide, and on a touch screen it never goes away.
  const hasToolbar = matchMedia("(hover: hover) and (min-width: 40rem)");
  const TOOLBAR = 38; // px: its height, which is kept free above the data

  let printing = false;

  const isDark = () => {
    if (printing) return false;
    const chosen = document.documentElement.dataset.theme;
    return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
  };
  const variable = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const textColor = () => (printing ? "#1b1f24" : variable("--text"));
  const lineColor = () => (printing ? "#c4ccd4" : variable("--line"));
  const mutedColor = () => (printing ? "#4a525c" : variable("--muted"));
  const paletteColor = (number) => {
    const palette = COLORS[isDark() ? "dark" : "light"];
    return palette[number % palette.length];
  };
  const fade = (hex, alpha) => {
    const [r, g, b] = [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
    return `rgba(${r}, ${g}, ${b}, ${alpha})`;
  };

  // ---- colors of the theme

  const withTheme = (layout, kind) => {
    const [text, line] = [textColor(), lineColor()];
    const axis = { gridcolor: line, zerolinecolor: line, linecolor: line, automargin: true };
    const result = {
      ...layout, paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
      font: { color: text, family: "system-ui, sans-serif" }, showlegend: false, // see drawLegend
    };
    if (printing) Object.assign(result, { width: PAPER.width, height: PAPER[kind], autosize: false });
    for (const key of Object.keys(result)) {
      if (/^[xy]axis/.test(key)) result[key] = { ...axis, ...result[key] };
    }
    if (result.scene) {
      result.scene = { ...result.scene };
      for (const key of ["xaxis", "yaxis", "zaxis"]) {
        result.scene[key] = { ...result.scene[key], gridcolor: line, zerolinecolor: line, backgroundcolor: "rgba(0,0,0,0)", color: text };
      }
    } else if (!hasToolbar.matches) {
      result.dragmode = false; // a swipe scrolls the page; it would zoom, with no button to zoom out
    } else if (!printing) {
      result.margin = { ...result.margin, t: Math.max(TOOLBAR, (result.margin || {}).t || 0) };
    }
    return result;
  };

  const withColor = (trace) => {
    if (trace.meta === undefined || trace.meta.color === undefined) return trace;
    const color = paletteColor(trace.meta.color);
    const result = { ...trace, line: { ...trace.line, color }, marker: { ...trace.marker, color } };
    if (trace.fill || trace.type === "box") result.fillcolor = fade(color, 0.2);
    return result;
  };

  const config = () => ({
    responsive: true, displaylogo: false, modeBarButtonsToRemove: ["toImage"],
    displayModeBar: hasToolbar.matches ? "hover" : false,
  });

  const drawings = []; // a function for each chart that redraws it in the current theme
  const redrawAll = () => drawings.forEach((redraw) => redraw());
  document.querySelector(".theme").addEventListener("click", () => {
    document.documentElement.dataset.theme = isDark() ? "light" : "dark";
    redrawAll();
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redrawAll);
  hasToolbar.addEventListener("change", redrawAll);

  const sourceOf = (element) => JSON.parse(document.getElementById(element.dataset.source).textContent);

  // ---- legends: lists, because a legend of plotly becomes a scroll box in a narrow chart

  const DASHES = { solid: "", dash: "8 4", dot: "2 3", dashdot: "8 3 2 3" };
  const SHAPES = {
    rect: '<svg viewBox="0 0 28 12" aria-hidden="true"><rect width="28" height="12" rx="2"/></svg>',
    line: '<svg viewBox="0 0 28 12" aria-hidden="true"><line x2="28" y1="6" y2="6" stroke-width="2.5"/></svg>',
  };
  const swatchOf = ({ color, dash, opacity }) => {
    const holder = document.createElement("template");
    holder.innerHTML = dash === undefined ? SHAPES.rect : SHAPES.line; // attributes from data are set below
    const swatch = holder.content.firstChild, shape = swatch.firstChild;
    shape.setAttribute("stroke", color);
    if (dash === undefined) {
      shape.setAttribute("fill", color);
      shape.setAttribute("fill-opacity", Math.max(opacity, 0.25));
    } else shape.setAttribute("stroke-dasharray", DASHES[dash] || "");
    return swatch;
  };

  // Entries with "toggle" become buttons that hide and show what they name.
  const drawLegend = (list, entries) => list.replaceChildren(...entries.map(({ label, isHidden, toggle, ...style }) => {
    const entry = document.createElement(toggle ? "button" : "span");
    entry.append(swatchOf(style), label);
    if (toggle) {
      entry.type = "button";
      entry.setAttribute("aria-pressed", String(!isHidden));
      entry.addEventListener("click", toggle);
    }
    const item = document.createElement("li");
    item.append(entry);
    return item;
  }));

  // ---- charts

  const setUpChart = (chart) => {
    const figure = sourceOf(chart), legend = chart.parentElement.querySelector(".legend"), hidden = new Set();
    const isHidden = (trace) => hidden.has(trace.legendgroup);
    const draw = () => {
      const traces = figure.data.map((trace) => (isHidden(trace) ? { ...withColor(trace), visible: false } : withColor(trace)));
      Plotly.react(chart, traces, withTheme(figure.layout, "chart"), config());
      const named = figure.data.filter((trace) => trace.meta && trace.meta.label !== undefined && trace.showlegend !== false);
      const toggle = (trace) => () => {
        if (!hidden.delete(trace.legendgroup)) hidden.add(trace.legendgroup);
        draw();
        legend.querySelectorAll("button")[named.indexOf(trace)].focus();
      };
      drawLegend(legend, named.map((trace) => ({
        label: trace.meta.label, color: paletteColor(trace.meta.color), dash: (trace.line || {}).dash || "solid",
        isHidden: isHidden(trace), toggle: toggle(trace),
      })));
    };
    draw();
    drawings.push(draw);
  };

  // ---- the moving body

  const decode = (text, kind) => new kind(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer);

  const readPart = (given) => {
    const faces = given.faces, seen = new Set(), edges = [];
    for (const face of faces) {
      face.forEach((start, corner) => {
        const end = face[(corner + 1) % 4], name = start < end ? `${start} ${end}` : `${end} ${start}`;
        if (!seen.has(name)) { seen.add(name); edges.push(start, end); }
      });
    }
    return { ...given, rest: decode(given.rest, Float32Array), moves: decode(given.moves, Int16Array), edges };
  };

  // Coordinates (mm) of all vertices at a time between two frames, with exaggerated displacements.
  const verticesAt = (part, frame, scale, step) => {
    const count = part.rest.length, low = Math.floor(frame), share = frame - low;
    const high = Math.min(low + 1, part.moves.length / count - 1), factor = scale * step;
    const result = [0, 1, 2].map(() => new Float32Array(count / 3));
    for (let at = 0; at < count; at += 1) {
      const moved = (1 - share) * part.moves[low * count + at] + share * part.moves[high * count + at];
      result[at % 3][(at / 3) | 0] = MM * (part.rest[at] + factor * moved);
    }
    return result;
  };

  const edgesOf = (part, coordinates) => coordinates.map((values) => {
    const result = [];
    for (let at = 0; at < part.edges.length; at += 2) result.push(values[part.edges[at]], values[part.edges[at + 1]], null);
    return result;
  });

  const meshOf = (part) => ({
    type: "mesh3d", name: part.name, color: part.color, opacity: part.opacity, hoverinfo: "skip",
    flatshading: true, lighting: { ambient: 0.75, diffuse: 0.35, specular: 0, roughness: 1, fresnel: 0, facenormalsepsilon: 0 },
    lightposition: { x: 2000, y: -4000, z: 6000 },
    i: part.faces.flatMap(([a]) => [a, a]), j: part.faces.flatMap(([, b, c]) => [b, c]), k: part.faces.flatMap(([, , c, d]) => [c, d]),
  });
  const linesOf = () => ({
    type: "scatter3d", mode: "lines", hoverinfo: "skip", line: { color: "rgba(0, 0, 0, 0.6)", width: 1.5 },
  });

  const setUpMotion = (motion) => {
    const given = sourceOf(motion);
    const find = (name) => motion.querySelector(name);
    const [body, chart, play, time, exaggeration] = [".body", ".trace", ".play", ".time", ".exaggeration"].map(find);
    const still = find(".still");
    const parts = given.parts.map(readPart), opaque = parts.filter((part) => part.opacity === 1);
    const last = given.times.length - 1, track = given.track;
    let frame = 0, scale = given.exaggeration, playing = 0;

    const valueAt = (values, at) => {
      const low = Math.floor(at), high = Math.min(low + 1, last);
      return values[low] + (at - low) * (values[high] - values[low]);
    };
    const pathAlong = (axis) => {
      const values = track.positions.map((position) => position[axis]);
      const until = [...values.slice(0, Math.floor(frame) + 1), valueAt(values, frame)];
      return until.map((value) => MM * (values[0] + scale * (value - values[0])));
    };
    const ranges = () => [0, 1, 2].map((axis) => {
      const [low, high, down, up] = given.bounds[axis];
      return [MM * (low + scale * down), MM * (high + scale * up)];
    });
    const coordinates = () => {
      const at = parts.map((part) => verticesAt(part, frame, scale, given.step));
      const edges = opaque.map((part) => edgesOf(part, at[parts.indexOf(part)]));
      const path = track ? [[0, 1, 2].map(pathAlong)] : [];
      return [...at, ...edges, ...path];
    };
    const traces = () => {
      const path = track ? [{
        type: "scatter3d", mode: "lines+markers", name: `trace of the ${track.name}`, hoverinfo: "skip",
        line: { color: textColor(), width: 5 }, marker: { size: 2, color: textColor() },
      }] : [];
      const result = [...parts.map(meshOf), ...opaque.map(linesOf), ...path], at = coordinates();
      result.forEach((trace, number) => { [trace.x, trace.y, trace.z] = at[number]; });
      return result;
    };
    const layout = () => {
      const aspect = printing ? PAPER.body / PAPER.width : body.clientHeight / body.clientWidth;
      const away = Math.max(1.2, 2.6 * aspect); // a narrow view needs distance
      const eye = { x: 0.75 * away, y: -1.3 * away, z: 0.55 * away };
      const scene = { aspectmode: "data", uirevision: "kept", camera: { eye, center: { x: 0, y: 0, z: -0.15 } } };
      ranges().forEach((range, axis) => { scene[`${"xyz"[axis]}axis`] = { range, title: { text: `${"xyz"[axis]} (mm)` }, nticks: 5 }; });
      return withTheme({ scene, margin: { l: 0, r: 0, t: 0, b: 0 }, uirevision: "kept" }, "body");
    };
    // The value of a slider is the number of a frame; screen readers read the text instead.
    const describe = (slider, beside, text) => { beside.textContent = text; slider.setAttribute("aria-valuetext", text); };
    const updateControls = () => {
      time.value = frame;
      describe(time, find(".seconds"), `${valueAt(given.times, frame).toFixed(4)} s`);
      describe(exaggeration, find(".factor"), `× ${scale}`);
    };
    const verticalLine = (at, dash) => ({
      type: "line", x0: at, x1: at, yref: "paper", y0: 0, y1: 1, line: { color: mutedColor(), width: 1, dash },
    });
    const shapes = () => [
      ...given.samples.map((sample) => verticalLine(sample.time, "dot")),
      ...(printing ? [] : [verticalLine(valueAt(given.times, frame), "solid")]),
    ];
    const labels = () => given.samples.map((sample) => ({
      text: `${sample.name}<br>${sample.time.toFixed(4)} s`, x: sample.time, y: 1, yref: "paper", yanchor: "bottom", showarrow: false,
      xanchor: sample.time < given.times[last] / 2 ? "left" : "right", align: sample.time < given.times[last] / 2 ? "left" : "right",
      font: { color: mutedColor(), size: 11 },
    }));
    const displacement = (position, axis) => MM * (position[axis] - track.positions[0][axis]);
    const drawTrace = () => {
      if (!track) { chart.remove(); return; }
      const hovertemplate = "%{y:.4f} mm at %{x:.4f} s";
      const style = (axis) => ({ name: "xyz"[axis], type: "scatter", meta: { color: axis }, hovertemplate });
      const dashes = ["dot", "dash", "solid"];
      const curves = [0, 1, 2].map((axis) => withColor({
        ...style(axis), mode: "lines", x: given.times, line: { dash: dashes[axis] },
        y: track.positions.map((position) => displacement(position, axis)),
      }));
      const marks = given.samples.length === 0 ? [] : [0, 1, 2].map((axis) => withColor({
        ...style(axis), mode: "markers", x: given.samples.map((sample) => sample.time), marker: { size: 8 },
        y: given.samples.map((sample) => displacement(sample.position, axis)), text: given.samples.map((sample) => sample.name),
        hovertemplate: `%{text}: ${hovertemplate}`,
      }));
      Plotly.react(chart, [...curves, ...marks], withTheme({
        xaxis: { title: { text: "time (s)" } }, yaxis: { title: { text: "displacement (mm)" } },
        shapes: shapes(), annotations: labels(), margin: { l: 56, r: 12, t: given.samples.length ? 36 : 8, b: 40 },
      }, "trace"), config());
      drawLegend(find(".of-trace"), [0, 1, 2].map((axis) => ({ label: `${"xyz"[axis]} of the ${track.label}`, color: paletteColor(axis), dash: dashes[axis] })));
    };
    const drawBodyLegend = () => {
      const path = track ? [{ label: `trace of the ${track.label}`, color: textColor(), dash: "solid" }] : [];
      drawLegend(find(".of-body"), [...parts.map(({ label, color, opacity }) => ({ label, color, opacity })), ...path]);
    };
    const draw = () => {
      Plotly.react(body, traces(), layout(), config());
      drawBodyLegend();
      drawTrace();
      updateControls();
    };
    const move = () => {
      const at = coordinates();
      const all = (axis) => at.map((one) => one[axis]);
      Plotly.restyle(body, { x: all(0), y: all(1), z: all(2) });
      if (track) Plotly.relayout(chart, { shapes: shapes() });
      updateControls();
    };
    const stop = () => { cancelAnimationFrame(playing); playing = 0; play.textContent = "play"; };
    const start = () => {
      let before; // time of the first animation frame, which may precede the click
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
    // A WebGL canvas is blank in print; a copy is not, if it is taken right after rendering.
    const copyForPrint = () => {
      stop();
      const scene = body._fullLayout?.scene?._scene, source = body.querySelector("canvas");
      if (!source || !scene?.glplot?.redraw) return;
      scene.glplot.redraw();
      [still.width, still.height] = [source.width, source.height];
      still.style.width = `${source.clientWidth}px`;
      still.getContext("2d").drawImage(source, 0, 0);
      still.hidden = false;
      body.classList.add("has-still");
    };

    time.max = last;
    exaggeration.max = given.most;
    exaggeration.value = scale;
    play.disabled = last === 0;
    play.addEventListener("click", () => (playing ? stop() : start()));
    time.addEventListener("input", () => { stop(); frame = Number(time.value); move(); });
    exaggeration.addEventListener("input", () => { scale = Number(exaggeration.value); draw(); });
    const redraw = () => {
      draw();
      if (printing) { copyForPrint(); return; }
      still.hidden = true;
      body.classList.remove("has-still");
    };
    redraw();
    drawings.push(redraw);
  };

  // ---- tables wider than the screen

  const fitting = new ResizeObserver((entries) => {
    for (const { target } of entries) target.nextElementSibling.hidden = target.scrollWidth <= target.clientWidth;
  });
  document.querySelectorAll(".scroll").forEach((table) => fitting.observe(table));

  // ---- draw each chart when it comes into view, and all of them for print

  const setUp = (target) => {
    watch.unobserve(target);
    (target.classList.contains("motion") ? setUpMotion : setUpChart)(target);
    target.dataset.drawn = "";
  };
  const watch = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target } of entries) {
      if (isIntersecting && target.dataset.drawn === undefined) setUp(target);
    }
  }, { rootMargin: "400px" });
  document.querySelectorAll(".chart, .motion").forEach((target) => watch.observe(target));

  addEventListener("beforeprint", () => {
    printing = true;
    redrawAll();
    document.querySelectorAll(".chart, .motion").forEach((target) => { if (target.dataset.drawn === undefined) setUp(target); });
  });
  addEventListener("afterprint", () => {
    printing = false;
    redrawAll();
  });
})();
