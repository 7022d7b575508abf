// Materials of a body: those of three.js with a few additional lines in their shaders.
import * as THREE from "three";

export type FieldUniforms = ReturnType<typeof makeFieldUniforms>;
export const makeFieldUniforms = () => ({
  fieldMap: { value: null as THREE.Texture | null },
  fieldLow: { value: 0 }, // logarithm of the value if fieldLog is set
  fieldScale: { value: 1 },
  fieldLog: { value: false },
  fieldShown: { value: false },
  insideColor: { value: new THREE.Color() },
  insideOwn: { value: true },
  inverted: { value: false },
  skin: { value: false },
});

type Uniforms = Record<string, THREE.IUniform>;
type Replacements = Record<string, string>; // text of a shader -> its replacement

function extend<M extends THREE.Material>(material: M, uniforms: Uniforms, vertex: Replacements, fragment: Replacements): M {
  const replaced = (shader: string, texts: Replacements): string =>
    Object.entries(texts).reduce((text, [old, replacement]) => text.replace(old, replacement), shader);
  material.onBeforeCompile = (shader) => {
    Object.assign(shader.uniforms, uniforms);
    shader.vertexShader = replaced(shader.vertexShader, vertex);
    shader.fragmentShader = replaced(shader.fragmentShader, fragment);
  };
  return material;
}

export const kGroundRadius = 7; // relative to the radius of the scene

const kFieldPars = /* glsl */ `
  uniform sampler2D fieldMap;
  uniform float fieldLow, fieldScale;
  uniform bool fieldLog, fieldShown, insideOwn, inverted, skin;
  uniform vec3 insideColor;
  varying float vFieldValue, vIsSheet;
`;

const kFieldColor = /* glsl */ `
  if (fieldShown) {
    float value = fieldLog ? (vFieldValue > 0.0 ? log(vFieldValue) : -1e30) : vFieldValue;
    float texels = float(textureSize(fieldMap, 0).x);
    float at = clamp((value - fieldLow) * fieldScale, 0.0, 1.0);
    diffuseColor.rgb = texture2D(fieldMap, vec2((at * (texels - 1.0) + 0.5) / texels, 0.5)).rgb;
    if (isnan(vFieldValue)) diffuseColor.rgb = vec3(0.3);
  }
  if (insideOwn && vIsSheet < 0.5 && gl_FrontFacing == inverted) diffuseColor.rgb = insideColor;
`;

// Red light travels farthest inside tissue: it brightens places with little light, and skin is translucent at its rim.
const kSkin = /* glsl */ `
  if (skin) {
    vec3 light = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
    vec3 share = clamp(light / max(diffuseColor.rgb, 1e-3), 0.0, 1.0);
    float rim = pow(1.0 - abs(dot(normal, normalize(vViewPosition))), 3.0);
    vec3 entered = vec3(0.5, 0.12, 0.06) * (1.0 - share) * sqrt(share) + vec3(0.25, 0.05, 0.03) * rim;
    reflectedLight.directDiffuse += diffuseColor.rgb * entered;
  }
`;

// If polygonOffset is on, surfaces lie behind the wires. The offset grows with the size of a pixel and exceeds gaps between
// bodies in small pictures, so all surfaces have it, and none without wires.
export const kSurface: THREE.MeshPhongMaterialParameters = {
  side: THREE.DoubleSide,
  clipShadows: true,
  polygonOffsetFactor: 1,
  polygonOffsetUnits: 2,
};

export function makeSurfaceMaterial(uniforms: FieldUniforms): THREE.MeshPhongMaterial {
  const material = new THREE.MeshPhongMaterial(kSurface);
  const vertex = {
    "#include <common>": "#include <common>\nattribute float fieldValue, isSheet;\nvarying float vFieldValue, vIsSheet;",
    "#include <begin_vertex>": "#include <begin_vertex>\nvFieldValue = fieldValue;\nvIsSheet = isSheet;",
  };
  const fragment = {
    "#include <common>": `#include <common>\n${kFieldPars}`,
    "#include <color_fragment>": kFieldColor,
    "#include <lights_fragment_end>": `#include <lights_fragment_end>\n${kSkin}`,
  };
  return extend(material, uniforms, vertex, fragment);
}

// Round markers of constant size on the screen, lifted in front of the surface by their width. `lift`: per distance, or in
// units of the stage when orthographic.
export function makePinMaterial(lift: { value: number }): THREE.PointsMaterial {
  const material = new THREE.PointsMaterial({ sizeAttenuation: false, transparent: true });
  const vertex = { "#include <common>": "#include <common>\nuniform float lift;", "#include <project_vertex>": kPinPosition };
  const fragment = {
    "#include <color_fragment>": "",
    "#include <map_particle_fragment>": `#include <color_fragment>\n${kPinColor}`,
  };
  return extend(material, { lift }, vertex, fragment);
}

const kPinPosition = /* glsl */ `
  #include <project_vertex>
  vec4 nearer = mvPosition;
  if (isPerspectiveMatrix(projectionMatrix)) nearer.xyz *= 1.0 - lift; else nearer.z += lift;
  gl_Position = projectionMatrix * nearer;
`;

const kPinColor = /* glsl */ `
  float radius = length(gl_PointCoord - 0.5) * 2.0;
  float blur = fwidth(radius);
  diffuseColor.rgb = mix(diffuseColor.rgb, vec3(1.0), smoothstep(0.62 - blur, 0.62 + blur, radius));
  diffuseColor.a *= 1.0 - smoothstep(1.0 - 2.0 * blur, 1.0, radius);
`;

// Ground that receives shadows, carries a grid, and fades toward its rim.
export function makeGroundMaterial(uniforms: Uniforms): THREE.ShadowMaterial {
  const material = new THREE.ShadowMaterial({ opacity: 0.3, side: THREE.DoubleSide, depthWrite: false });
  const vertex = {
    "#include <common>": "#include <common>\nvarying vec2 vPlane;",
    "#include <begin_vertex>": "#include <begin_vertex>\nvPlane = position.xy;",
  };
  const fragment = {
    "#include <common>": `#include <common>\n${kGroundPars}`,
    "#include <shadowmask_pars_fragment>": THREE.ShaderChunk.shadowmask_pars_fragment.replace("directionalLight.shadowRadius", "shadowBlur * $&"),
    "gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );": kGroundColor,
  };
  return extend(material, uniforms, vertex, fragment);
}

const kGroundPars = /* glsl */ `
  uniform float gridStep, shadowBlur;
  uniform bool gridLines;
  uniform vec2 gridOrigin;
  uniform vec3 gridColor;
  varying vec2 vPlane;
`;

const kGroundColor = /* glsl */ `
  vec2 cell = (vPlane - gridOrigin) / gridStep;
  vec2 blur = max(fwidth(cell), 1e-6);
  vec2 line = clamp(1.0 - abs(fract(cell - 0.5) - 0.5) / blur, 0.0, 1.0) * (1.0 - smoothstep(0.15, 0.5, blur));
  float far = length(vPlane) / ${kGroundRadius.toFixed(1)};
  float grid = gridLines ? 0.1 + 0.4 * max(line.x, line.y) : 0.16 * (1.0 - smoothstep(0.05, 0.16, far));
  float shade = opacity * (1.0 - getShadowMask());
  float fade = 1.0 - smoothstep(0.35, 1.0, far);
  float cover = 1.0 - (1.0 - shade) * (1.0 - grid);
  gl_FragColor = vec4(mix(color, gridColor, cover > 0.0 ? grid * (1.0 - shade) / cover : 0.0), fade * cover);
`;
