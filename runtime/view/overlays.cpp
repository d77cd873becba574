#include "runtime/view/overlays.h"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "mesher/base/error.h"

namespace liana {
namespace {

constexpr ImGuiWindowFlags kPlain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                                    ImGuiWindowFlags_NoNav;

void row(const char* name, const char* format, auto value) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextColored({0.70f, 0.78f, 0.74f, 1.0f}, "%s", name);
  ImGui::TableNextColumn();
  ImGui::Text(format, value);
}

void draw_stats(const OverlayText& text, float margin) {
  ImGui::SetNextWindowPos({margin, margin});
  ImGui::SetNextWindowBgAlpha(0.55f);
  if (ImGui::Begin("stats", nullptr, kPlain) &&
      ImGui::BeginTable("numbers", 2, ImGuiTableFlags_SizingFixedFit)) {
    // Fixed widths: a column that follows its text is a frame late and cuts the text off.
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthFixed, 5.5f * ImGui::GetFontSize());
    ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthFixed, 6.5f * ImGui::GetFontSize());
    row("time", "%.2f s", text.stats.time);
    row("steps", "%zu", text.stats.steps);
    row("particles", "%zu", text.stats.particles);
    row("anchors", "%zu", text.stats.anchors);
    row("frames/s", "%.1f", text.frames_per_second);
    row("draw", "%.1f ms", text.draw_ms);
    row("physics", "%.2f ms", text.stats.physics_ms);
    row("growth", "%.2f ms", text.stats.growth_ms);
    row("collision", "%.2f ms", text.stats.collision_ms);
    if (text.stats.wind_ms > 0) row("wind", "%.2f ms", text.stats.wind_ms);
    if (text.stats.redone_steps > 0) row("redone", "%zu steps", text.stats.redone_steps);
    ImGui::EndTable();
  }
  ImGui::End();
}

void draw_help(const OverlayText& text, float margin, float height) {
  ImGui::SetNextWindowPos({margin, height - margin}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowBgAlpha(0.55f);
  if (ImGui::Begin("help", nullptr, kPlain)) {
    if (text.paused) {
      ImGui::TextColored({1.0f, 0.8f, 0.3f, 1.0f}, "paused");
      ImGui::SameLine();
    }
    ImGui::TextUnformatted(
        text.grabbing ? "drag to bend the plant, let go to release it"
                      : "drag a branch: bend it | drag elsewhere or middle: orbit | shift or right: pan | "
                        "wheel: zoom | space: pause | . step | X cut | F frame all | S numbers | Q quit");
  }
  ImGui::End();
}

}  // namespace

Overlay::Overlay() {
  ImGuiContext* const before = ImGui::GetCurrentContext();
  context_ = ImGui::CreateContext();
  ImGui::SetCurrentContext(context_);
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::StyleColorsDark();
  ImGui::GetStyle().WindowRounding = 4;
  ImGui::GetStyle().WindowBorderSize = 0;
  require(ImGui_ImplOpenGL3_Init("#version 330 core"), "ImGui cannot use this OpenGL context");
  ImGui::SetCurrentContext(before);
}

Overlay::~Overlay() {
  ImGui::SetCurrentContext(context_);
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext(context_);
}

void Overlay::draw(const OverlayText& text, int width, int height, float scale) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {float(width), float(height)};
  io.DeltaTime = 1.0f / 60;
  io.FontGlobalScale = scale;
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
  if (text.stats_shown) draw_stats(text, 10 * scale);
  draw_help(text, 10 * scale, float(height));
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace liana
