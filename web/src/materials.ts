// Material presets: one published measurement where there is a source, otherwise a typical order of magnitude. Real
// materials vary from sample to sample and are not linear. Poisson's ratio stays below the 0.5 of incompressible matter
// so that every solver converges.

export interface MaterialPreset {
  name: string;
  young: number; // [Pa]
  poisson: number;
  density: number; // [kg/m^3]
  source: string;
}

const kTypical = "A typical order of magnitude; samples differ by factors.";

export const kMaterials: readonly MaterialPreset[] = [
  { name: "Soft silicone", young: 7e4, poisson: 0.49, density: 1070, source: kTypical },
  {
    name: "Silicone (PDMS, Sylgard 184)",
    young: 1.32e6,
    poisson: 0.49,
    density: 1030,
    source: "Johnston et al., J. Micromech. Microeng. 24, 035017 (2014): 1.32 to 2.97 MPa, depending on the temperature of curing; typical density.",
  },
  { name: "Natural rubber", young: 1e6, poisson: 0.49, density: 950, source: kTypical },
  {
    name: "Gelatin, 5 %",
    young: 1.25e4,
    poisson: 0.49,
    density: 1000,
    source: "Nguyen et al., Ultrasound Med. Biol. 40, 168-176 (2014): shear modulus of 4.18 kPa, E = 3 G; density of water.",
  },
  { name: "Fat", young: 3e3, poisson: 0.49, density: 920, source: kTypical },
  {
    name: "Muscle, relaxed",
    young: 1.2e4,
    poisson: 0.49,
    density: 1060,
    source: "Engler et al., J. Cell Biol. 166, 877-887 (2004): about 12 kPa, passive; typical density.",
  },
  { name: "Skin", young: 4e5, poisson: 0.49, density: 1100, source: kTypical },
];
