#include "viewer/window/panels.hpp"

#include "viewer/stage/legend.hpp"
#include "viewer/stage/palette.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace carom::viewer {

namespace {

constexpr float margin = 10;         ///< pixels, of panels from the window's edges
constexpr float control_width = 300; ///< pixels
constexpr float side_width = 300;    ///< pixels, of the panels at the right
constexpr float value_column = 80;   ///< pixels, where values stand in their panel

std::string number(double value) { return fmt::format("{:.4g}", value); }

std::string vector_text(const Vec3& v) { return fmt::format("{:.3g} {:.3g} {:.3g}", v.x, v.y, v.z); }

void row(const char* name, const std::string& value) {
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine(value_column);
    ImGui::TextUnformatted(value.c_str());
}

/// A panel that is as high as what is in it.
void begin_panel(const char* name, ImVec2 place, ImVec2 pivot, float width) {
    ImGui::SetNextWindowPos(place, ImGuiCond_Always, pivot);
    ImGui::SetNextWindowSize({width, 0});
    ImGui::Begin(name, nullptr, ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse);
}

ImU32 packed(const Colour& c) { return ImGui::ColorConvertFloat4ToU32({c.red, c.green, c.blue, c.opacity}); }

void plot(const char* name, const std::deque<PlotRow>& rows, double PlotRow::* member, const char* unit) {
    std::vector<float> values;
    values.reserve(rows.size());
    for (const PlotRow& entry : rows) values.push_back(static_cast<float>(entry.*member));
    const auto [low, high] = values.empty() ? std::pair{0.0F, 1.0F}
                                            : std::pair{*std::min_element(values.begin(), values.end()),
                                                        *std::max_element(values.begin(), values.end())};
    const float room = std::max(0.08F * (high - low), 1e-6F * std::max(std::abs(low), std::abs(high)));
    row(name, rows.empty() ? "" : fmt::format("{:.5g} {}", rows.back().*member, unit));
    ImGui::PlotLines(fmt::format("##{}", name).c_str(), values.data(), static_cast<int>(values.size()), 0, nullptr,
                     low - room, high + room, {side_width - 16, 38});
}

/// The window's picture, under all panels.
class WindowCanvas final : public Canvas {
public:
    void rectangle(float left, float top, float width, float height, const Colour& colour) override {
        list_.AddRectFilled({left, top}, {left + width, top + height}, packed(colour));
    }
    void text(float left, float top, const std::string& line) override {
        list_.AddText({left, top}, packed(text_colour), line.c_str());
    }
    [[nodiscard]] float width_of(const std::string& line) const override { return ImGui::CalcTextSize(line.c_str()).x; }

private:
    ImDrawList& list_ = *ImGui::GetBackgroundDrawList();
};

} // namespace

void set_style() {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 6;
    style.FrameRounding = 4;
    style.GrabRounding = 4;
    style.WindowBorderSize = 0;
    style.Colors[ImGuiCol_WindowBg] = {0.07F, 0.08F, 0.10F, 0.82F};
    style.Colors[ImGuiCol_TitleBgActive] = {0.13F, 0.17F, 0.23F, 0.95F};
    style.Colors[ImGuiCol_SliderGrab] = {0.22F, 0.42F, 0.68F, 1};
    style.Colors[ImGuiCol_SliderGrabActive] = {0.28F, 0.52F, 0.84F, 1};
    style.Colors[ImGuiCol_PlotLines] = {0.95F, 0.78F, 0.40F, 1};
    style.Colors[ImGuiCol_PlotHistogram] = {0.40F, 0.62F, 0.80F, 1};
}

void Panels::note(const char* label) {
    const ImVec2 low = ImGui::GetItemRectMin();
    const ImVec2 high = ImGui::GetItemRectMax();
    widgets_[label] = {low.x, low.y, high.x - low.x, high.y - low.y};
}

bool Panels::button(const char* label) {
    const bool pressed = ImGui::Button(label);
    note(label);
    return pressed;
}

bool Panels::check(const char* label, bool& value) {
    const bool changed = ImGui::Checkbox(label, &value);
    note(label);
    return changed;
}

bool Panels::slider(const char* label, double& value, double low, double high, const char* format, bool logarithmic) {
    const bool changed = ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &low, &high, format,
                                             logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
    note(label);
    widgets_[label].z = ImGui::CalcItemWidth(); // without the label
    return changed;
}

std::optional<std::filesystem::path> Panels::draw(Session* session, Browser& browser, PanelState& state) {
    widgets_.clear();
    std::optional<std::filesystem::path> chosen;
    if (session != nullptr && !state.hidden) {
        draw_control(*session, state);
        if (session->picked()) draw_picked(*session);
        draw_measurements(*session);
        draw_scale(*session);
    }
    if (state.browser) draw_browser(browser, state, chosen);
    if (state.help) draw_help(state);
    draw_messages(session, state);
    return chosen;
}

void Panels::draw_control(Session& session, PanelState& state) {
    begin_panel("carom", {margin, margin}, {0, 0}, control_width);
    ImGui::TextWrapped("%s", session.title().c_str());
    draw_time(session);
    ImGui::Separator();
    draw_view(session, state);
    draw_sound(state);
    ImGui::Separator();
    draw_world(session);
    ImGui::Separator();
    if (button("Scenes")) state.browser = !state.browser;
    ImGui::SameLine();
    if (button("Help (F1)")) state.help = !state.help;
    control_bottom_ = ImGui::GetWindowPos().y + ImGui::GetWindowSize().y;
    ImGui::End();
}

void Panels::draw_time(Session& session) {
    row("time", fmt::format("{:.4f} s", session.time()));
    row("rate", fmt::format("{:.3g} x real time", session.paused() ? 0.0 : session.time_scale_reached()));
    const bool late = session.lag() > 1e-9;
    if (late) ImGui::PushStyleColor(ImGuiCol_Text, ImVec4{1, 0.7F, 0.3F, 1});
    row("lag", fmt::format("{:.3g} s", session.lag()));
    if (late) ImGui::PopStyleColor();
    if (button(session.paused() ? "Play" : "Pause")) session.set_paused(!session.paused());
    ImGui::SameLine();
    if (button("Back")) session.step_back();
    ImGui::SameLine();
    if (button("Step")) session.step();
    ImGui::SameLine();
    if (button("Restart")) session.restart();
    slider("speed", session.time_scale, 1e-3, 1e3, "x %.3g", true);
}

void Panels::draw_view(Session& session, PanelState& state) {
    auto colour = static_cast<int>(session.colour_by());
    const auto name = [](void*, int i, const char** text) {
        *text = scene::colour_names[static_cast<std::size_t>(i)].data();
        return true;
    };
    if (ImGui::Combo("colour", &colour, name, nullptr, static_cast<int>(scene::colour_names.size()))) {
        session.colour_by(static_cast<scene::ColourBy>(colour));
    }
    note("colour");
    auto mode = static_cast<int>(session.rig().mode());
    constexpr std::array<const char*, 3> modes{"orbit", "fly", "follow"};
    for (int i = 0; i < 3; ++i) {
        if (i > 0) ImGui::SameLine();
        if (ImGui::RadioButton(modes[static_cast<std::size_t>(i)], &mode, i))
            session.rig().set_mode(static_cast<CameraMode>(i));
        note(modes[static_cast<std::size_t>(i)]);
    }
    double trails = session.trails();
    if (slider("trails", trails, 0, 10, "%.2f s")) session.set_trails(trails);
    bool forces = session.forces();
    if (check("forces", forces)) session.show_forces(forces);
    ImGui::SameLine();
    check("shadows", state.shadows);
    ImGui::SameLine();
    check("fine", state.fine);
}

void Panels::draw_sound(PanelState& state) {
    if (!state.silence.empty()) {
        ImGui::TextDisabled("%s", state.silence.c_str());
        state.try_sound = button("Retry");
        return;
    }
    constexpr float width = 130; // pixels
    ImGui::SetNextItemWidth(width);
    slider("volume", state.volume, 0, 1, "%.2f");
    widgets_["volume"].z = width;
    ImGui::SameLine(0, 30);
    check("mute", state.muted);
}

void Panels::draw_world(Session& session) {
    const Vec3 up = unit(session.rig().camera().up);
    double upwards = dot(session.gravity, up);
    const double most = std::max(20.0, 2 * std::abs(upwards));
    if (slider("gravity", upwards, -most, most, "%.2f m/s\u00b2")) {
        session.set_gravity(session.gravity + up * (upwards - dot(session.gravity, up)));
    }
    Drag drag = session.drag;
    if (slider("drag", drag.linear, 0, 5, "%.2f /s")) session.set_drag(drag);
    double restitution = session.restitution;
    if (slider("restitution", restitution, 0, 1, "e = %.2f")) session.set_restitution(restitution);
    ImGui::TextDisabled("shots (F): speed, radius, mass");
    const double scale = session.scale();
    slider("##shot speed", session.projectile.speed, 0.01 * scale, 100 * scale, "%.3g m/s", true);
    slider("##shot radius", session.projectile.radius, 1e-3 * scale, 0.3 * scale, "%.3g m", true);
    slider("##shot mass", session.projectile.mass, 1e-3, 1e9, "%.3g kg", true);
}

void Panels::draw_picked(Session& session) {
    const Status status = session.status();
    if (!status.picked) return;
    const PickedBody& picked = *status.picked;
    const float right = ImGui::GetIO().DisplaySize.x - margin;
    begin_panel("body", {right, margin}, {1, 0}, side_width);
    const std::string held = picked.held ? ", held" : "";
    row("number", fmt::format("{}{}", picked.id.slot, held));
    row("place (m)", vector_text(picked.body.position));
    row("v (m/s)", vector_text(picked.body.velocity));
    row("speed", number(length(picked.body.velocity)) + " m/s");
    row("mass", picked.body.mass == infinite_mass ? "static" : number(picked.body.mass) + " kg");
    row("radius", number(picked.body.radius) + " m");
    row("e, mu", fmt::format("{:.3g}, {:.3g}", picked.body.restitution, picked.body.friction));
    if (picked.next) {
        const std::string with = picked.next->other.is_set() ? fmt::format("body {}", picked.next->other.slot)
                                                             : fmt::format("face {}", picked.next->face);
        row("meets", fmt::format("{} in {:.4g} s", with, picked.next->in));
    } else {
        row("meets", "nothing soon");
    }
    if (button("Follow")) session.rig().set_mode(CameraMode::follow);
    ImGui::SameLine();
    if (button("Let go (Esc)")) session.pick(std::nullopt);
    ImGui::End();
}

void Panels::draw_measurements(Session& session) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    begin_panel("measurements", {size.x - margin, size.y - margin}, {1, 1}, side_width);
    const Status status = session.status();
    row("bodies", fmt::format("{}", status.bodies));
    row("step", fmt::format("{}  {:.3g} ms", status.steps, 1e3 * status.step_seconds));
    row("impacts", fmt::format("{}", status.ledger.impacts + status.ledger.face_impacts));
    row("contacts", fmt::format("{}", status.report.contacts));
    plot("kinetic", session.plots(), &PlotRow::kinetic, "J");
    plot("energy", session.plots(), &PlotRow::total, "J");
    plot("impacts", session.plots(), &PlotRow::impact_rate, "/s");
    draw_phases(status);
    ImGui::End();
}

/// Where the time of the last step went.
void Panels::draw_phases(const Status& status) {
    const PhaseTimes& s = status.report.seconds;
    const std::array<std::pair<const char*, double>, 6> phases{{{"forces", s.forces},
                                                                {"contacts", s.contacts},
                                                                {"cells", s.cells},
                                                                {"pairs", s.pairs},
                                                                {"impacts", s.impacts},
                                                                {"bodies", s.bodies}}};
    double sum = 0;
    for (const auto& [name, seconds] : phases) sum += seconds;
    for (const auto& [name, seconds] : phases) {
        const float part = sum > 0 ? static_cast<float>(seconds / sum) : 0;
        row(name, fmt::format("{:.3g} ms", 1e3 * seconds));
        ImGui::SameLine(2 * value_column);
        ImGui::ProgressBar(part, {-1, ImGui::GetTextLineHeight()}, "");
    }
}

/// In the lower left corner, beside the control panel where that reaches so far down.
void Panels::draw_scale(const Session& session) {
    const auto legend = legend_of(session.colour_by(), session.moment()->lowest, session.moment()->highest);
    if (!legend) return;
    const float bottom = ImGui::GetIO().DisplaySize.y - margin;
    const bool beside = bottom - legend_height < control_bottom_ + margin;
    WindowCanvas canvas;
    draw_legend(*legend, beside ? control_width + 2 * margin : margin, bottom, 1, canvas);
}

void Panels::draw_browser(Browser& browser, PanelState& state, std::optional<std::filesystem::path>& chosen) {
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    constexpr float cell = Browser::thumbnail_width + 18.0F;
    const int columns = std::clamp(static_cast<int>((size.x - control_width - 40) / cell), 1, 4);
    ImGui::SetNextWindowPos({control_width + 2 * margin, margin}, ImGuiCond_Appearing);
    ImGui::SetNextWindowSizeConstraints({0, 0}, {size.x, std::max(size.y - 2 * margin, margin)});
    ImGui::SetNextWindowBgAlpha(0.96F);
    ImGui::Begin("scenes", &state.browser, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse);
    int column = 0;
    for (const BrowserEntry& entry : browser.entries()) {
        const std::string name = entry.file.stem().string();
        if (column % columns != 0) ImGui::SameLine();
        ++column;
        ImGui::BeginGroup();
        const ImVec2 picture{Browser::thumbnail_width, Browser::thumbnail_height};
        ImGui::PushID(name.c_str());
        const bool pressed = entry.texture != nullptr
                                 ? ImGui::ImageButton(entry.texture, picture)
                                 : ImGui::Button(entry.known ? "no picture" : "...", {picture.x + 8, picture.y + 6});
        note(name.c_str());
        ImGui::PopID();
        if (pressed) chosen = entry.file;
        if (ImGui::IsItemHovered()) {
            ImGui::SetTooltip("%s", (entry.scene.problem.empty() ? entry.scene.title : entry.scene.problem).c_str());
        }
        ImGui::TextUnformatted(name.c_str());
        ImGui::EndGroup();
    }
    if (browser.entries().empty()) ImGui::TextUnformatted("no scene files here");
    ImGui::End();
}

void Panels::draw_help(PanelState& state) {
    constexpr std::array<std::pair<const char*, const char*>, 18> lines{{{"Space", "pause, go on"},
                                                                         {"Right", "one step"},
                                                                         {"Left", "one step back"},
                                                                         {"R", "restart"},
                                                                         {"drag", "turn around what is in the middle"},
                                                                         {"right drag", "shift"},
                                                                         {"wheel", "nearer, farther"},
                                                                         {"1 2 3", "camera: orbit, fly, follow"},
                                                                         {"W A S D Q E", "fly; with Shift faster"},
                                                                         {"H", "camera back to where it began"},
                                                                         {"click", "pick a body"},
                                                                         {"F", "shoot at what is under the mouse"},
                                                                         {"C", "next meaning of colours"},
                                                                         {"T", "trails"},
                                                                         {"M", "sound off, and on"},
                                                                         {"B", "scenes"},
                                                                         {"P", "panels away, and back"},
                                                                         {"Esc", "let go, close this"}}};
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowBgAlpha(0.96F);
    ImGui::Begin("help", &state.help, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse);
    for (const auto& [key, meaning] : lines) {
        ImGui::TextColored({0.95F, 0.78F, 0.40F, 1}, "%s", key);
        ImGui::SameLine(110);
        ImGui::TextUnformatted(meaning);
    }
    ImGui::Separator();
    ImGui::TextDisabled("%s", state.device.c_str());
    const std::string coarse = state.divisor > 1 ? fmt::format(", drawn at 1/{} of its size", state.divisor) : "";
    ImGui::TextDisabled("a frame takes %.1f ms%s", 1e3 * state.frame_seconds, coarse.c_str());
    ImGui::End();
}

void Panels::draw_messages(const Session* session, const PanelState& state) {
    std::string text = state.problem;
    if (!state.loading.empty()) text = "opening " + state.loading + " ...";
    if (text.empty() && session != nullptr) text = session->status().problem;
    if (text.empty()) return;
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({size.x / 2, size.y - margin}, ImGuiCond_Always, {0.5F, 1});
    ImGui::Begin("message", nullptr,
                 ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs);
    ImGui::PushTextWrapPos(std::max(size.x * 0.5F, 200.0F));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
}

} // namespace carom::viewer
