// SPDX-License-Identifier: MIT
// The light of lamps in the air of a picture, and the lamps over it.

//// lamps.picture.glsl
// Light of lamps scattered by the air in a picture [cd/m^2, linear sRGB], from the lattice of
// lamps.airlight.frag.glsl and the cores of lamps.core.frag.glsl, or summed here.

// Returns the distance at which the ray of a pixel ends [m]: at terrain (surface_m, 0: none), at
// the bare planet, or nowhere.
float LampRayEnd(vec3 direction, float surface_m) {
  float h = lamp_planet.y;
  bool planet = GroundClearance(h, direction.z, lamp_planet.x) > 0.0;
  float to_planet = 1e3 * DistanceDownTo(h, min(direction.z, -1e-9), 0.0, lamp_planet.x);
  return surface_m > 0.0 ? surface_m : planet ? to_planet : 1e12;
}

int LampStep() { return int(lamp_planet.z); }

#if LAMP_LATTICE
uniform sampler2D lamp_lattice;  // light; inverse of the distance at which the ray ends [1/m]

// Rays that end on one plane, or in the sky, have inverse distances that are linear over the
// picture. If that of the pixel does not fit, the neighbours whose rays end nearest to it are used.
vec3 LampAirlightRgb(vec3 direction, float end_m) {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  ivec2 corner = pixel / LampStep();
  vec2 share = vec2(pixel - corner * LampStep()) / float(LampStep());
  vec4 a = texelFetch(lamp_lattice, corner, 0);
  vec4 b = texelFetch(lamp_lattice, corner + ivec2(1, 0), 0);
  vec4 c = texelFetch(lamp_lattice, corner + ivec2(0, 1), 0);
  vec4 d = texelFetch(lamp_lattice, corner + ivec2(1, 1), 0);
  vec4 weight = vec4((1.0 - share.x) * (1.0 - share.y), share.x * (1.0 - share.y),
                     (1.0 - share.x) * share.y, share.x * share.y);
  vec4 ends = vec4(a.w, b.w, c.w, d.w);
  float here = 1.0 / end_m;
  bool plane = abs(dot(weight, ends) - here) <= 0.03 * here + 1e-9;
  vec4 alike = 1.0 / (0.01 + abs(ends - here) / (ends + here + 1e-9));
  vec4 chosen = weight * alike * alike;
  weight = plane ? weight : chosen / dot(chosen, vec4(1.0));
  return weight.x * a.rgb + weight.y * b.rgb + weight.z * c.rgb + weight.w * d.rgb;
}
#else
vec3 LampAirlightRgb(vec3 direction, float end_m) { return LampRgb(LampAirlightIn(direction, end_m, 1.0)); }
#endif

//// lamps.none.glsl
// Replaces lamp_light.glsl and lamps.picture.glsl in scenes without lamps.
vec4 LampsOnGround(vec3 point_m, vec3 normal, float ray_width_m) { return vec4(0.0); }

vec3 LampAirlightRgb(vec3 direction, float end_m) { return vec3(0.0); }

vec3 LampRgb(vec4 radiance) { return vec3(0.0); }

//// lamps.airlight.frag.glsl
// Scattered light of lamps at every LampStep()-th pixel, without the cores, and the inverse of the
// distance at which the ray ends [1/m].
out vec4 lattice;

uniform sampler2D surface_map;
uniform vec2 picture_size;  // [pixels]

void main() {
  vec2 at = floor(gl_FragCoord.xy) * float(LampStep());
  vec2 screen = (2.0 * at + 1.0) / picture_size - 1.0;
  vec3 direction = ViewDirection(screen);
  ivec2 texel = min(ivec2(at), textureSize(surface_map, 0) - 1);
  float end_m = LampRayEnd(direction, texelFetch(surface_map, texel, 0).w);
  lattice = vec4(LampRgb(LampAirlightIn(direction, end_m, 0.0)), 1.0 / end_m);
}

//// lamps.corners.glsl
// Squares around directions in the picture, for the parts of lamps that are drawn over it.

// Returns a corner (gl_VertexID 0 to 3 of a strip) of the square that holds all directions within
// an angle [rad] of `towards`, or a point outside the picture if that direction is behind the eye.
vec4 LampCorner(vec3 towards, float angle) {
  vec2 size = vec2(length(view_right.xyz), length(view_up.xyz));
  float ahead = dot(towards, view_forward.xyz);
  vec2 place = vec2(dot(towards, view_right.xyz), dot(towards, view_up.xyz)) / (size * size);
  vec2 corner = vec2(gl_VertexID % 2, gl_VertexID / 2) * 2.0 - 1.0;
  if (ahead < 2.0 * angle + 0.02) return vec4(2.0, 2.0, 2.0, 1.0);
  float edge = ahead - angle;
  return vec4(place / ahead - PICTURE_SHIFT + corner * 1.1 * angle / (size * edge * edge), 0.0, 1.0);
}

//// lamps.core.vert.glsl
// The square of a lamp's core, for lamp gl_InstanceID of the block.
out vec2 screen;
flat out int number;

void main() {
  number = gl_InstanceID;
  Lamp lamp = lamps[gl_InstanceID];
  gl_Position = LampCorner(lamp.position.xyz / lamp.profile.z, lamp.glow.z * lamp_count.z);
  if (lamp.glow.z <= 0.0) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  screen = gl_Position.xy;
}

//// lamps.core.frag.glsl
// Scattered light close to a lamp, which the lattice does not resolve, added to the picture.
in vec2 screen;
flat in int number;
out vec4 picture;

uniform sampler2D surface_map;

void main() {
  vec3 direction = ViewDirection(screen);
  float part = LampCore(lamps[number], direction);
  if (part <= 0.0) discard;
  float end_m = LampRayEnd(direction, texelFetch(surface_map, ivec2(gl_FragCoord.xy), 0).w);
  picture = vec4(part * LampRgb(GlowOfLamp(lamps[number], direction, end_m, true)), 0.0);
}

//// lamps.disk.vert.glsl
// The square of a lamp's disk, unless terrain hides its centre.
in vec4 disk_towards;  // unit vector; angular radius [rad]
in vec4 disk_light;    // irradiance at the eye, one value per band [W m^-2 nm^-1]
in vec4 disk_place;    // distance [m]
out vec2 screen;
flat out vec4 towards;
flat out vec3 light;

uniform sampler2D surface_map;
uniform float pixel_angle;  // [rad]

// A lamp stands on terrain or just above it. It is visible if the ray of at least one pixel around
// its centre reaches as far as the lamp.
bool IsHidden(vec2 screen, float distance_m) {
  ivec2 size = textureSize(surface_map, 0);
  ivec2 middle = ivec2(floor((0.5 * screen + 0.5) * vec2(size)));
  if (any(lessThan(middle, ivec2(1))) || any(greaterThan(middle, size - 2))) return false;
  float reach = 0.99 * distance_m - 0.5;
  for (int i = 0; i < 9; ++i) {
    float seen = texelFetch(surface_map, middle + ivec2(i % 3 - 1, i / 3 - 1), 0).w;
    if (seen <= 0.0 || seen > reach) return false;
  }
  return true;
}

void main() {
  towards = vec4(disk_towards.xyz, max(disk_towards.w, 0.9 * pixel_angle));
  light = LampRgb(disk_light);
  vec4 corner = LampCorner(towards.xyz, towards.w);
  float ahead = max(dot(towards.xyz, view_forward.xyz), 1e-6);
  vec2 size = vec2(dot(view_right.xyz, view_right.xyz), dot(view_up.xyz, view_up.xyz));
  vec2 middle =
      vec2(dot(towards.xyz, view_right.xyz), dot(towards.xyz, view_up.xyz)) / (size * ahead) -
      PICTURE_SHIFT;
  bool hidden = IsHidden(middle, disk_place.x);
  gl_Position = hidden ? vec4(2.0, 2.0, 2.0, 1.0) : corner;
  screen = gl_Position.xy;
}

//// lamps.disk.frag.glsl
// The disk of a lamp, at least as large as a pixel, added to the picture.
in vec2 screen;
flat in vec4 towards;
flat in vec3 light;
out vec4 picture;

void main() {
  vec3 direction = ViewDirection(screen);
  float off = length(direction - towards.xyz) / towards.w;
  picture = vec4(SoftDiskPerSr(min(off, 1.0), towards.w) * light, 0.0);
}
