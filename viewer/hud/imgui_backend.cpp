// SPDX-License-Identifier: MIT
#include "viewer/hud/imgui_backend.h"

// GLFW is included for its key numbers alone.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "atmosphere/base/error.h"
#include "viewer/gl/gl_context.h"
#include "viewer/gl/render_target.h"
#include "viewer/layer.h"
#include "viewer/shaders/pass_setup.h"

namespace alpenglow::viewer {
namespace {

constexpr double kLetterHeight = 14.0;  // units
constexpr double kBuiltInHeight_px = 13.0;

void AddBuiltIn(ImFontAtlas& atlas, double scale) {
  ImFontConfig config;
  config.SizePixels = static_cast<float>(kBuiltInHeight_px * std::max(std::round(scale), 1.0));
  config.PixelSnapH = true;
  atlas.AddFontDefault(&config);
}

void AddFile(ImFontAtlas& atlas, double scale, const std::filesystem::path& file) {
  static constexpr std::array<ImWchar, 7> kLetters{0x20, 0x17F, 0x370, 0x3FF, 0x400, 0x45F, 0};
  const auto height = static_cast<float>(std::round(kLetterHeight * scale));
  // Dear ImGui aborts the program if the file is missing.
  if (!std::filesystem::is_regular_file(file) ||
      atlas.AddFontFromFileTTF(file.c_str(), height, nullptr, kLetters.data()) == nullptr) {
    throw InputError(fmt::format("\"{}\" is no TrueType font", file.string()));
  }
}

ImVec4 Vec4(const HudColour& colour) { return {colour[0], colour[1], colour[2], colour[3]}; }

ImVec4 Dimmed(const HudColour& colour, float opacity) {
  return {colour[0], colour[1], colour[2], colour[3] * opacity};
}

void ApplyColours(ImGuiStyle& style, const HudColours& colours) {
  const ImVec4 panel = Vec4(colours.panel), control = Vec4(colours.control);
  const ImVec4 active = Vec4(colours.active), quiet = Vec4(colours.quiet);
  for (const int part : {ImGuiCol_WindowBg, ImGuiCol_PopupBg, ImGuiCol_MenuBarBg, ImGuiCol_TitleBg,
                         ImGuiCol_TitleBgCollapsed}) {
    style.Colors[part] = panel;
  }
  // Frames keep their colour under the mouse, so that the grab of a slider stands out from them.
  for (const int part :
       {ImGuiCol_FrameBg, ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive, ImGuiCol_Button,
        ImGuiCol_Header, ImGuiCol_TitleBgActive, ImGuiCol_ScrollbarGrab, ImGuiCol_TableHeaderBg}) {
    style.Colors[part] = control;
  }
  for (const int part :
       {ImGuiCol_SliderGrab, ImGuiCol_SliderGrabActive, ImGuiCol_TextSelectedBg,
        ImGuiCol_ButtonHovered, ImGuiCol_ButtonActive, ImGuiCol_HeaderHovered,
        ImGuiCol_HeaderActive, ImGuiCol_ScrollbarGrabHovered, ImGuiCol_ScrollbarGrabActive,
        ImGuiCol_ResizeGripHovered, ImGuiCol_ResizeGripActive, ImGuiCol_SeparatorHovered,
        ImGuiCol_SeparatorActive}) {
    style.Colors[part] = active;
  }
  for (const int part : {ImGuiCol_ScrollbarBg, ImGuiCol_TableRowBg, ImGuiCol_TableRowBgAlt}) {
    style.Colors[part] = Dimmed(colours.control, 0.4F);
  }
  style.Colors[ImGuiCol_CheckMark] = Vec4(colours.accent);
  style.Colors[ImGuiCol_Text] = Vec4(colours.text);
  style.Colors[ImGuiCol_TextDisabled] = quiet;
  for (const int part : {ImGuiCol_Border, ImGuiCol_Separator, ImGuiCol_ResizeGrip,
                         ImGuiCol_TableBorderLight, ImGuiCol_TableBorderStrong}) {
    style.Colors[part] = Dimmed(colours.quiet, 0.3F);
  }
}

/// Keys that edit text or navigate panels.
constexpr std::pair<int, int> kPanelKeys[] = {{ImGuiKey_Tab, GLFW_KEY_TAB},
                                              {ImGuiKey_LeftArrow, GLFW_KEY_LEFT},
                                              {ImGuiKey_RightArrow, GLFW_KEY_RIGHT},
                                              {ImGuiKey_UpArrow, GLFW_KEY_UP},
                                              {ImGuiKey_DownArrow, GLFW_KEY_DOWN},
                                              {ImGuiKey_PageUp, GLFW_KEY_PAGE_UP},
                                              {ImGuiKey_PageDown, GLFW_KEY_PAGE_DOWN},
                                              {ImGuiKey_Home, GLFW_KEY_HOME},
                                              {ImGuiKey_End, GLFW_KEY_END},
                                              {ImGuiKey_Insert, GLFW_KEY_INSERT},
                                              {ImGuiKey_Delete, GLFW_KEY_DELETE},
                                              {ImGuiKey_Backspace, GLFW_KEY_BACKSPACE},
                                              {ImGuiKey_Space, GLFW_KEY_SPACE},
                                              {ImGuiKey_Escape, GLFW_KEY_ESCAPE},
                                              {ImGuiKey_A, GLFW_KEY_A},
                                              {ImGuiKey_C, GLFW_KEY_C},
                                              {ImGuiKey_V, GLFW_KEY_V},
                                              {ImGuiKey_X, GLFW_KEY_X},
                                              {ImGuiKey_Y, GLFW_KEY_Y},
                                              {ImGuiKey_Z, GLFW_KEY_Z}};

#if IMGUI_VERSION_NUM >= 18700
void FeedKey(ImGuiIO& io, int key, bool is_down) {
  io.AddKeyEvent(static_cast<ImGuiKey>(key), is_down);
}
void FeedModifiers(ImGuiIO& io, bool control, bool shift) {
#if IMGUI_VERSION_NUM >= 18900
  io.AddKeyEvent(ImGuiMod_Ctrl, control);
  io.AddKeyEvent(ImGuiMod_Shift, shift);
#else
  io.AddKeyEvent(ImGuiKey_ModCtrl, control);
  io.AddKeyEvent(ImGuiKey_ModShift, shift);
#endif
}
#else
// Key codes are mapped to themselves.
void FeedKey(ImGuiIO& io, int key, bool is_down) {
  io.KeyMap[key] = key;
  io.KeysDown[key] = is_down;
}
void FeedModifiers(ImGuiIO& io, bool control, bool shift) {
  io.KeyCtrl = control;
  io.KeyShift = shift;
}
#endif

void FeedMouse(ImGuiIO& io, const WindowEvents& events) {
  constexpr float kNowhere = -std::numeric_limits<float>::max();
  io.MousePos = events.pointer ? ImVec2{static_cast<float>(events.pointer->right),
                                        static_cast<float>(events.pointer->down)}
                               : ImVec2{kNowhere, kNowhere};
  std::copy(events.buttons.begin(), events.buttons.end(), io.MouseDown);
  io.MouseWheel = static_cast<float>(events.wheel);
}

constexpr GLuint kPlace = 0, kAtlasPlace = 1, kColour = 2;
constexpr int kAtlasUnit = 0;

const void* Offset(std::size_t bytes) { return reinterpret_cast<const void*>(bytes); }

// Uploads data that are drawn once.
template <typename Element>
void Upload(GLenum target, const GlBuffer& buffer, const ImVector<Element>& elements) {
  glBindBuffer(target, buffer.id());
  glBufferData(target, static_cast<GLsizeiptr>(elements.size_in_bytes()), elements.Data,
               GL_STREAM_DRAW);
}

// Sets the scissor to a rectangle given from the upper left corner; OpenGL counts from the lower
// left one. Returns false if the rectangle is outside the picture.
bool Clip(const ImVec4& rectangle, const ImVec2& size) {
  const int left = std::max(static_cast<int>(rectangle.x), 0);
  const int top = std::max(static_cast<int>(rectangle.y), 0);
  const int right = std::min(static_cast<int>(rectangle.z), static_cast<int>(size.x));
  const int bottom = std::min(static_cast<int>(rectangle.w), static_cast<int>(size.y));
  if (right <= left || bottom <= top) return false;
  glScissor(left, static_cast<int>(size.y) - bottom, right - left, bottom - top);
  return true;
}

}  // namespace

std::optional<std::filesystem::path> InstalledFont() {
  for (const char* folder : {"truetype/dejavu", "dejavu-sans-fonts", "TTF", "dejavu"}) {
    const std::filesystem::path file =
        std::filesystem::path("/usr/share/fonts") / folder / "DejaVuSans.ttf";
    if (std::filesystem::is_regular_file(file)) return file;
  }
  return std::nullopt;
}

void LoadFont(ImFontAtlas& atlas, double scale, const std::optional<std::filesystem::path>& font) {
  atlas.Clear();
  if (font) {
    AddFile(atlas, scale, *font);
  } else {
    AddBuiltIn(atlas, scale);
  }
  atlas.Build();
}

void ApplyStyle(HudTheme theme, double scale) {
  ImGuiStyle style;
  style.WindowRounding = 4.0F;
  style.FrameRounding = 3.0F;
  style.GrabRounding = 3.0F;
  style.FramePadding = {6.0F, 3.0F};
  style.ScaleAllSizes(static_cast<float>(scale));
  ApplyColours(style, ColoursOf(theme));
  ImGui::GetStyle() = style;
}

void PanelKeys::Take(const WindowEvents& events) {
  pressed_.clear();
  for (const KeyEvent& event : events.keys) {
    std::erase(held_, event.key);
    if (event.change == GLFW_RELEASE) continue;
    held_.push_back(event.key);
    pressed_.push_back(event.key);
  }
  if (!events.focused) held_.clear();
}

bool PanelKeys::IsDown(int glfw_key) const {
  const auto has = [&](const std::vector<int>& keys) {
    return std::find(keys.begin(), keys.end(), glfw_key) != keys.end();
  };
  return has(held_) || has(pressed_);
}

void FeedInput(ImGuiIO& io, const InputFrame& input, const PanelKeys& keys) {
  constexpr float kShortest_s = 1e-4F;  // Dear ImGui requires a positive time step
  const auto either = [&](int one, int other) { return keys.IsDown(one) || keys.IsDown(other); };
  io.DisplaySize = {static_cast<float>(input.size.width), static_cast<float>(input.size.height)};
  io.DeltaTime = std::max(static_cast<float>(input.seconds), kShortest_s);
  FeedMouse(io, input.events);
  FeedModifiers(io, either(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL),
                either(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT));
  for (const auto& [key, glfw_key] : kPanelKeys) FeedKey(io, key, keys.IsDown(glfw_key));
  FeedKey(io, ImGuiKey_Enter, either(GLFW_KEY_ENTER, GLFW_KEY_KP_ENTER));
  io.AddInputCharactersUTF8(input.events.text.c_str());
}

DrawListPainter::DrawListPainter()
    : program_({ViewerPiece("viewer/shaders/hud/hud.vert.glsl")},
               {ViewerPiece("viewer/shaders/hud/hud.frag.glsl")},
               {{kPlace, "place"}, {kAtlasPlace, "atlas_place"}, {kColour, "colour"}}) {
  program_.BindSampler("atlas", kAtlasUnit);
  glBindVertexArray(layout_.id());
  glBindBuffer(GL_ARRAY_BUFFER, corners_.id());
  constexpr GLsizei kStride = sizeof(ImDrawVert);
  glVertexAttribPointer(kPlace, 2, GL_FLOAT, GL_FALSE, kStride, Offset(offsetof(ImDrawVert, pos)));
  glVertexAttribPointer(kAtlasPlace, 2, GL_FLOAT, GL_FALSE, kStride,
                        Offset(offsetof(ImDrawVert, uv)));
  glVertexAttribPointer(kColour, 4, GL_UNSIGNED_BYTE, GL_TRUE, kStride,
                        Offset(offsetof(ImDrawVert, col)));
  for (const GLuint attribute : {kPlace, kAtlasPlace, kColour})
    glEnableVertexAttribArray(attribute);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, order_.id());
  glBindVertexArray(0);
}

void DrawListPainter::UploadAtlas(ImFontAtlas& atlas) {
  unsigned char* coverage = nullptr;
  int width = 0, height = 0;
  atlas.GetTexDataAsAlpha8(&coverage, &width, &height);
  BindTexture(kAtlasUnit, GL_TEXTURE_2D, atlas_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  UploadTexture(GL_TEXTURE_2D, atlas_,
                {GL_R8, width, height, 1, GL_RED, GL_UNSIGNED_BYTE, coverage});
}

void DrawListPainter::Paint(const ImDrawData& data, GLuint framebuffer) const {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glViewport(0, 0, static_cast<GLsizei>(data.DisplaySize.x),
             static_cast<GLsizei>(data.DisplaySize.y));
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendEquation(GL_FUNC_ADD);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  glEnable(GL_SCISSOR_TEST);
  program_.Use();
  glUniform2f(program_.Uniform("picture_size"), data.DisplaySize.x, data.DisplaySize.y);
  BindTexture(kAtlasUnit, GL_TEXTURE_2D, atlas_);
  glBindVertexArray(layout_.id());
  for (int i = 0; i < data.CmdListsCount; ++i) PaintList(*data.CmdLists[i], data);
  glBindVertexArray(0);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  CheckGl("instruments and panels");
}

void DrawListPainter::PaintList(const ImDrawList& list, const ImDrawData& data) const {
  Upload(GL_ARRAY_BUFFER, corners_, list.VtxBuffer);
  Upload(GL_ELEMENT_ARRAY_BUFFER, order_, list.IdxBuffer);
  constexpr GLenum kIndex = sizeof(ImDrawIdx) == 2 ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;
  for (const ImDrawCmd& command : list.CmdBuffer) {
    if (command.ElemCount == 0 || !Clip(command.ClipRect, data.DisplaySize)) continue;
    glDrawElementsBaseVertex(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount), kIndex,
                             Offset(command.IdxOffset * sizeof(ImDrawIdx)),
                             static_cast<GLint>(command.VtxOffset));
  }
}

}  // namespace alpenglow::viewer
