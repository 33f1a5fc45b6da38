// SPDX-License-Identifier: MIT
// Light that the air scatters into a ray: single scattering and light of higher orders, by
// Gauss-Legendre in the mapped distance of ray_map.glsl.

uniform vec2 gauss[32];  // nodes in [0, 1] and weights of the rules

void Order(inout float a, inout float b) {
  float low = min(a, b);
  b = max(a, b);
  a = low;
}

// Distances at which the integrand is not smooth: ends, shadow, perigee; ascending.
float[5] CutsOf(AirRay ray, vec2 shadow) {
  float perigee = clamp(-(RADIUS + ray.h) * ray.mu, 0.0, ray.reach);
  float x = clamp(shadow.x, 0.0, ray.reach);
  float y = clamp(shadow.y, 0.0, ray.reach);
  Order(x, y);
  Order(x, perigee);
  Order(perigee, y);
  return float[5](0.0, x, perigee, y, ray.reach);
}

// What is integrated along a ray, per unit solar irradiance [1/sr].
struct AirLight {
  vec4 single;         // direct sunlight scattered once
  vec4 diffuse;        // light of higher orders; 0 unless asked for
  vec4 transmittance;  // of the ray [1]
};

// In-scattered light along a ray. @param first, count  of the rule in `gauss`.
AirLight LightAlong(AirRay ray, int first, int count, bool with_single, bool with_diffuse) {
  AirLight light = AirLight(vec4(0.0), vec4(0.0), vec4(1.0));
  if (ray.reach <= 0.0) return light;
  vec3 origin = ColumnsUp(ray.h, abs(ray.mu));
  vec3 lowest = ColumnsFromPerigee(ray.h, ray.mu);
  vec2 shadow = ShadowOf(ray);
  float cuts[5] = CutsOf(ray, shadow);
  float phase_rayleigh = PhaseRayleigh(ray.nu);
  vec4 phase_mie = PhaseMie(ray.nu);
  for (int panel = 0; panel < 4; ++panel) {
    float begin = cuts[panel];
    float span = cuts[panel + 1] - begin;
    if (span <= 1e-6 * ray.reach) continue;
    float middle = begin + 0.5 * span;
    bool lit = !(middle > shadow.x && middle < shadow.y);
    if (!(with_diffuse || lit)) continue;
    float z_begin = AltitudeAlongRay(ray.h, ray.mu, begin, RADIUS);
    float z_end = AltitudeAlongRay(ray.h, ray.mu, begin + span, RADIUS);
    bool up = z_end >= z_begin;
    float low = max(min(z_begin, z_end), 0.0);
    float at = up ? begin : begin + span;
    float cosine = abs(ZenithCosineAlongRay(ray.h, ray.mu, at, low, RADIUS));
    float b = PanelStretch(low, cosine, span, mie_options.y, 1.0, RADIUS);
    float scale = b > 0.0 ? StretchedScale(span, exp(b)) : 0.0;
    for (int i = 0; i < count; ++i) {
      vec2 node = gauss[first + i];
      float t = span * node.x;
      float slope = span;
      if (b > 0.0) {
        float growth = exp(b * node.x);
        t = StretchedDistance(scale, growth);
        slope = StretchedSlope(scale, b, growth);
      }
      AirPoint point = PointAt(ray, up ? begin + t : begin + span - t, node.y * slope);
      vec3 view =
          ColumnsBetween(ray.mu, point.mu, origin, ColumnsUp(point.h, abs(point.mu)), lowest);
      vec4 tau = OpticalDepth(view);
      if (with_single && lit) {
        vec4 source = rayleigh_scattering * (point.rayleigh * phase_rayleigh) +
                      mie_scattering * (point.mie * phase_mie);
        vec4 depth = tau + OpticalDepth(ColumnsToSun(point.h, point.mu_s));
        light.single += point.weight * exp(-depth) * source;
      }
      if (with_diffuse) light.diffuse += point.weight * exp(-tau) * DiffuseSource(point, ray.nu);
    }
  }
  AirPoint end = PointAt(ray, ray.reach, 0.0);
  light.transmittance = exp(
      -OpticalDepth(ColumnsBetween(ray.mu, end.mu, origin, ColumnsUp(end.h, abs(end.mu)), lowest)));
  return light;
}
