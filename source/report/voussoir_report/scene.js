// Scenes that turn: each <div class="scene"> has its data in a script element, and
// shows its picture where the browser cannot draw the scene.
(() => {
  const decoded = (text, Kind) => new Kind(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer);

  async function library() {
    const packed = decoded(document.getElementById("vtk-js").textContent.trim(), Uint8Array);
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    const script = document.createElement("script");
    script.textContent = await new Response(stream).text();
    document.head.append(script);
    return window.vtk;
  }

  // quadrilaterals with corners of their own
  function surface(vtk, points, colours) {
    const data = vtk.Common.DataModel.vtkPolyData.newInstance();
    data.getPoints().setData(points, 3);
    const n = points.length / 12;
    const cells = new Uint32Array(5 * n);
    for (let i = 0; i < n; ++i) cells.set([4, 4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3], 5 * i);
    data.getPolys().setData(cells);
    if (colours)
      data.getPointData().setScalars(
        vtk.Common.Core.vtkDataArray.newInstance({name: "colours", numberOfComponents: 3, values: colours}));
    const mapper = vtk.Rendering.Core.vtkMapper.newInstance();
    mapper.setInputData(data);
    const actor = vtk.Rendering.Core.vtkActor.newInstance();
    actor.setMapper(mapper);
    const look = actor.getProperty();
    look.setInterpolationToFlat();
    look.setAmbient(0.5);
    look.setDiffuse(0.55);
    return {data, actor, look};
  }

  function draw(vtk, place) {
    const scene = JSON.parse(place.querySelector("script").textContent);
    const metres = (text) => Float32Array.from(decoded(text, Int16Array), (v) => v * scene.unit);
    const start = metres(scene.dam);
    const motion = Float32Array.from(decoded(scene.motion, Int16Array), (v) => v * scene.motionUnit);

    const window3d = vtk.Rendering.Misc.vtkGenericRenderWindow.newInstance({background: [1, 1, 1]});
    const canvas = place.querySelector(".canvas");
    place.classList.add("drawn");
    window3d.setContainer(canvas);
    window3d.resize();
    const renderer = window3d.getRenderer();
    const colours = decoded(scene.colours, Uint8Array);
    const concrete = (from, to) => {
      const part = surface(vtk, start.slice(from, to), colours.slice(from, to));
      part.look.setEdgeVisibility(true);
      part.look.setEdgeColor(0.25, 0.25, 0.25);
      renderer.addActor(part.actor);
      return part;
    };
    // fragments without motion are the last ones
    const moving = motion.length || start.length;
    const dam = concrete(0, moving);
    const fragments = moving < start.length ? concrete(moving, start.length) : null;
    const rockPoints = metres(scene.rock);
    const rock = rockPoints.length ? surface(vtk, rockPoints) : null;
    if (rock) {
      rock.look.setColor(...scene.stone);
      renderer.addActor(rock.actor);
    }
    // as in the picture: parallel projection, the dam as large as fits
    const camera = renderer.getActiveCamera();
    camera.setFocalPoint(0, 0, 0);
    camera.setPosition(...scene.eye);
    camera.setViewUp(0, 0, 1);
    camera.setParallelProjection(true);
    renderer.resetCamera(dam.data.getBounds());
    const toEye = camera.getViewMatrix();
    const reach = [0, 4].map((row) => {
      let low = Infinity, high = -Infinity;
      for (let i = 0; i < start.length; i += 3) {
        const at = toEye[row] * start[i] + toEye[row + 1] * start[i + 1] + toEye[row + 2] * start[i + 2] + toEye[row + 3];
        low = Math.min(low, at);
        high = Math.max(high, at);
      }
      return high - low;
    });
    camera.setParallelScale(0.6 * Math.max(reach[1], reach[0] * canvas.clientHeight / canvas.clientWidth));
    renderer.resetCameraClippingRange();

    const render = () => window3d.getRenderWindow().render();
    const slider = place.querySelector("input[type=range]"); // where there is a motion
    if (slider) slider.addEventListener("input", () => {
      const factor = Number(slider.value);
      place.querySelector("output").textContent = `${factor.toPrecision(3)} times`;
      dam.data.getPoints().setData(motion.map((value, i) => start[i] + factor * value), 3);
      dam.data.modified();
      if (fragments) fragments.actor.setVisibility(factor === 0);
      render();
    });
    const box = place.querySelector("input[type=checkbox]");
    box.addEventListener("change", () => {
      if (rock) rock.actor.setVisibility(box.checked);
      render();
    });
    new ResizeObserver(() => { window3d.resize(); render(); }).observe(canvas);
    render();
    place.dataset.state = "turns";
  }

  window.addEventListener("load", async () => {
    for (const place of document.querySelectorAll(".scene"))
      try {
        draw(window.vtk || await library(), place);
      } catch (error) {
        place.classList.remove("drawn");
        place.dataset.state = "failed";
        place.querySelector(".hint").textContent = `This browser does not draw the scene (${error.message}).`;
      }
  });
})();
