// Materials to start from: published moduli of homogeneous samples at small strains. Real materials differ from sample to
// sample, and are not linear; Poisson's ratio is below the 0.5 of incompressible matter so that every solver converges.

export interface MaterialPreset {
  name: string;
  young: number; // [Pa]
  poisson: number;
  density: number; // [kg/m^3]
  source: string;
}

export const kMaterials: readonly MaterialPreset[] = [
  {
    name: "Soft silicone (Ecoflex 00-30)",
    young: 6.9e4,
    poisson: 0.49,
    density: 1070,
    source: "Smooth-On, technical bulletin of the Ecoflex series: 100 % modulus of 10 psi, 1.07 g/cm³.",
  },
  {
    name: "Silicone (PDMS, Sylgard 184)",
    young: 1.32e6,
    poisson: 0.49,
    density: 1030,
    source: "Johnston et al., J. Micromech. Microeng. 24, 035017 (2014): 1.32 MPa when cured at 25 °C; density of the data sheet.",
  },
  {
    name: "Natural rubber",
    young: 1.17e6,
    poisson: 0.49,
    density: 950,
    source: "Treloar, The Physics of Rubber Elasticity (1975): shear modulus of 0.39 MPa at 8 % sulfur, E = 3 G; typical density.",
  },
  {
    name: "Gelatin, 5 %",
    young: 1.25e4,
    poisson: 0.49,
    density: 1000,
    source: "Nguyen et al., Ultrasound Med. Biol. 40, 168-176 (2014): shear modulus of 4.18 kPa, E = 3 G; density of water.",
  },
  {
    name: "Fat",
    young: 3.25e3,
    poisson: 0.49,
    density: 911,
    source: "Samani et al., Phys. Med. Biol. 52, 1565-1576 (2007): 3.25 kPa, normal breast fat; density of the IT'IS database.",
  },
  {
    name: "Muscle, relaxed",
    young: 1.2e4,
    poisson: 0.49,
    density: 1060,
    source: "Engler et al., J. Cell Biol. 166, 877-887 (2004): about 12 kPa; density of Mendez and Keys, Metabolism 9, 184-188 (1960).",
  },
  {
    name: "Skin",
    young: 4.2e5,
    poisson: 0.49,
    density: 1109,
    source: "Agache et al., Arch. Dermatol. Res. 269, 221-232 (1980): 0.42 MPa in vivo, younger than 30; density of the IT'IS database.",
  },
];
