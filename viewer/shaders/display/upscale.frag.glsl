// SPDX-License-Identifier: MIT
// Upscales a picture that is smaller than the screen. Where the four nearest pixels lie on the same
// surface as this fragment, they are interpolated bilinearly. At an edge of land, whose position
// `outline` holds at screen resolution, the pixels at about the fragment's distance are used.
// DITHERS is 1 for display codes, else 0.
uniform sampler2D small_picture;  // fourth component: InverseDepthOf (gbuffer/inverse_depth.glsl)
uniform sampler2D outline;        // depth of DepthPrepass; of the screen's size
uniform vec2 half_view;           // tangents of half the horizontal and vertical field of view
in vec2 screen;
out vec4 shown;

// Returns the weights of four pixels with inverse depths `near` for a place between them with
// inverse depth `own`.
vec4 WeightsAt(vec2 share, vec4 near, float own) {
  const float kEven = 0.02, kTolerance = 0.01;
  vec2 left = 1.0 - share;
  vec4 weight = vec4(left.x * left.y, share.x * left.y, left.x * share.y, share.x * share.y);
  float between = dot(weight, near);
  vec4 off = (near - own) / max(max(own, between), 1e-9);
  // A minimum weight of a thousandth lets a pixel count if all nearer ones belong to other land.
  vec4 alike = (weight + 1e-3) / (off * off + kTolerance * kTolerance);
  bool is_even = abs(between - own) <= kEven * own;
  return is_even ? weight : alike / dot(alike, vec4(1.0));
}

vec4 SmallAt(vec2 screen, float own) {
  ivec2 last = textureSize(small_picture, 0) - 1;
  vec2 at = clamp((0.5 * screen + 0.5) * vec2(last + 1) - 0.5, vec2(0.0), vec2(last));
  ivec2 low = ivec2(at);
  ivec2 high = min(low + 1, last);
  vec4 a = texelFetch(small_picture, low, 0);
  vec4 b = texelFetch(small_picture, ivec2(high.x, low.y), 0);
  vec4 c = texelFetch(small_picture, ivec2(low.x, high.y), 0);
  vec4 d = texelFetch(small_picture, high, 0);
  vec4 weight = WeightsAt(at - vec2(low), vec4(a.w, b.w, c.w, d.w), own);
  return weight.x * a + weight.y * b + weight.z * c + weight.w * d;
}

void main() {
  float slant = length(vec3(screen * half_view, 1.0));
  float depth = texelFetch(outline, ivec2(gl_FragCoord.xy), 0).x;
  vec4 found = SmallAt(screen, InverseDepthOf(depth, slant));
#if DITHERS
  shown = vec4(Dithered(found.rgb), 1.0);
#else
  shown = found;
#endif
}
