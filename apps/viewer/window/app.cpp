#include "viewer/window/app.hpp"

#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

namespace carom::viewer {

namespace {

/// A key for the cameras that are remembered: the same from whatever folder a scene is opened.
std::string key_of(const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::weakly_canonical(file, error);
    return error ? file.string() : whole.string();
}

} // namespace

App::App(Screen& screen, Settings settings, const std::filesystem::path& scenes, bool lockstep)
    : screen_(screen), settings_(std::move(settings)), browser_(scenes), lockstep_(lockstep) {
    state_.device = screen.renderer().device();
    // Several samples a pixel are too much for a renderer in software, and scripts see the same with every renderer.
    state_.fine = !lockstep && state_.device.find("llvmpipe") == std::string::npos;
    state_.volume = settings_.volume;
    state_.muted = settings_.muted;
}

App::~App() = default;

void App::open(const std::filesystem::path& file) {
    state_.loading = file.filename().string();
    state_.problem.clear();
    opening_ = std::async(std::launch::async, [file] { return std::make_unique<Session>(file); });
}

void App::show(std::unique_ptr<Session> session) {
    remember_camera();
    close_session();
    session_ = std::move(session);
    ears_.begin_scene(session_->sound_settings());
    const auto known = settings_.cameras.find(key_of(session_->file()));
    if (known != settings_.cameras.end()) session_->rig().set_camera(known->second);
}

/// Its step may be a slow one, which the window does not wait for.
void App::close_session() {
    using namespace std::chrono_literals;
    std::erase_if(closing_, [](const auto& closing) { return closing.wait_for(0s) == std::future_status::ready; });
    if (session_)
        closing_.push_back(std::async(std::launch::async, [old = std::move(session_)]() mutable { old.reset(); }));
}

std::vector<std::future<void>> App::close() {
    close_session();
    if (opening_.valid()) {
        closing_.push_back(std::async(std::launch::async, [unseen = std::move(opening_)] { unseen.wait(); }));
    }
    return std::exchange(closing_, {});
}

void App::finish_opening() {
    using namespace std::chrono_literals;
    if (!opening_.valid()) return;
    if (!lockstep_ && opening_.wait_for(0s) != std::future_status::ready) return;
    state_.loading.clear();
    try {
        show(opening_.get());
    } catch (const std::exception& error) {
        state_.problem = error.what();
    }
}

void App::remember_camera() {
    if (session_) settings_.cameras[key_of(session_->file())] = session_->rig().camera();
}

Settings App::settings(int width, int height) {
    remember_camera();
    settings_.width = width;
    settings_.height = height;
    settings_.volume = state_.volume;
    settings_.muted = state_.muted;
    return settings_;
}

void App::frame(double seconds, int width, int height) {
    const auto begin = std::chrono::steady_clock::now();
    constexpr double newest = 0.05; // of the mean
    state_.frame_seconds += (seconds - state_.frame_seconds) * newest;
    width_ = std::max(width, 1);
    height_ = std::max(height, 1);
    finish_opening();
    if (state_.browser) browser_.go_on(screen_);

    feed_interface(seconds, width_, height_);
    screen_.begin_interface();
    ImGui::NewFrame();
    const auto chosen = panels_.draw(session_.get(), browser_, state_);
    ImGui::Render();
    if (chosen) open(*chosen);

    obey_keys();
    set_sound();
    if (session_) {
        obey_mouse(seconds);
        const double before = session_->time();
        session_->advance(seconds, lockstep_);
        hear(before, seconds);
    }
    input_.next_frame();
    const bool still = stands_still();
    state_.divisor = state_.fine || lockstep_ || still ? 1 : detail_.divisor();
    draw_picture(width_, height_);
    screen_.present(width_, height_);
    if (!still) detail_.took(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}

bool App::stands_still() const {
    if (!session_ || !session_->paused()) return false;
    const Camera& camera = session_->rig().camera();
    return session_->moment() == last_moment_.lock() && camera.position == last_camera_.position &&
           camera.target == last_camera_.target;
}

void App::feed_interface(double seconds, int width, int height) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
    io.DeltaTime = std::max(static_cast<float>(seconds), 1e-4F);
    io.MousePos = {static_cast<float>(input_.mouse_x()), static_cast<float>(input_.mouse_y())};
    io.MouseDown[0] = input_.is_down(MouseButton::left);
    io.MouseDown[1] = input_.is_down(MouseButton::right);
    io.MouseDown[2] = input_.is_down(MouseButton::middle);
    io.MouseWheel = static_cast<float>(input_.wheel());
    io.KeyShift = input_.is_down(Key::shift);
}

void App::obey_keys() {
    for (const Key key : input_.pressed()) obey_key(key);
}

void App::obey_key(Key key) {
    if (key == Key::f1) state_.help = !state_.help;
    if (key == Key::p) state_.hidden = !state_.hidden;
    if (key == Key::m) state_.muted = !state_.muted;
    if (key == Key::b) state_.browser = !state_.browser;
    if (key == Key::escape && std::exchange(state_.help, false)) return;
    if (key == Key::escape && std::exchange(state_.browser, false)) return;
    if (!session_) return;
    Session& session = *session_;
    switch (key) {
    case Key::space:
        return session.set_paused(!session.paused());
    case Key::right:
        return session.step();
    case Key::left:
        return session.step_back();
    case Key::r:
        return session.restart();
    case Key::h:
        return session.go_home();
    case Key::f:
        return session.shoot(under_mouse());
    case Key::c:
        return session.colour_by(static_cast<scene::ColourBy>((static_cast<std::size_t>(session.colour_by()) + 1) %
                                                              scene::colour_names.size()));
    case Key::t:
        return session.set_trails(session.trails() > 0 ? 0 : 2);
    case Key::one:
        return session.rig().set_mode(CameraMode::orbit);
    case Key::two:
        return session.rig().set_mode(CameraMode::fly);
    case Key::three:
        return session.rig().set_mode(CameraMode::follow);
    case Key::escape:
        return session.pick(std::nullopt);
    default:
        return;
    }
}

void App::set_sound() {
    ears_.set_volume(state_.muted ? 0 : state_.volume);
    if (std::exchange(state_.try_sound, false)) ears_.try_again();
    state_.silence = ears_.problem();
}

void App::hear(double before, double seconds) {
    session_->hear(ears_.audible() && !state_.muted);
    ears_.add(session_->take_strikes());
    ears_.hear(before, session_->time(), seconds, session_->listener());
}

Place App::under_mouse() const {
    return {input_.mouse_x(), input_.mouse_y(), static_cast<double>(width_), static_cast<double>(height_)};
}

/// What happens over a panel is the panel's.
void App::obey_mouse(double seconds) {
    if (ImGui::GetIO().WantCaptureMouse) return;
    session_->rig().move(input_, seconds, session_->scale(), height_);
    if (input_.clicked()) session_->pick_at(under_mouse());
}

void App::draw_picture(int width, int height) {
    Renderer& renderer = screen_.renderer();
    // The largest picture that the driver draws, where the window is larger.
    const int supersample = state_.fine && 2 * std::max(width, height) <= renderer.largest_side() ? 2 : 1;
    if (!session_) {
        renderer.draw(empty_.draw({}, 0, {}), {width, height, supersample});
        return;
    }
    Drawing& settings = session_->stage().settings();
    settings.shadows = state_.shadows;
    settings.occlusion = state_.shadows;
    settings.line_scale = 1 / static_cast<float>(state_.divisor);
    const Drawing& drawing = session_->draw();
    renderer.draw(drawing, {std::max(width / state_.divisor, 1), std::max(height / state_.divisor, 1), supersample});
    last_camera_ = drawing.camera;
    last_moment_ = session_->moment();
}

std::map<std::string, double> App::facts() {
    std::map<std::string, double> facts{{"gl_errors", static_cast<double>(screen_.renderer().errors())},
                                        {"opened", session_ ? 1 : 0},
                                        {"problem", state_.problem.empty() ? 0 : 1},
                                        {"help", state_.help ? 1 : 0},
                                        {"browser", state_.browser ? 1 : 0},
                                        {"thumbnails", static_cast<double>(browser_.pictures())},
                                        {"audible", ears_.audible() ? 1 : 0},
                                        {"silence", state_.silence.empty() ? 0 : 1},
                                        {"strikes_heard", static_cast<double>(ears_.heard())},
                                        {"volume", state_.muted ? 0 : state_.volume},
                                        {"width", width_},
                                        {"height", height_}};
    if (!session_) return facts;
    const Status status = session_->status();
    const Camera& camera = session_->rig().camera();
    facts.insert({{"time", session_->time()},
                  {"lag", session_->lag()},
                  {"steps", static_cast<double>(status.steps)},
                  {"bodies", static_cast<double>(status.bodies)},
                  {"impacts", static_cast<double>(status.ledger.impacts + status.ledger.face_impacts)},
                  {"paused", session_->paused() ? 1 : 0},
                  {"picked", session_->picked() ? 1 : 0},
                  {"picked_slot", session_->picked() ? session_->picked()->slot : -1.0},
                  {"next_impact", status.picked && status.picked->next ? status.picked->next->in : -1.0},
                  {"gravity", length(session_->gravity)},
                  {"drag", session_->drag.linear},
                  {"restitution", session_->restitution},
                  {"energy", status.energy.total()},
                  {"plot_rows", static_cast<double>(session_->plots().size())},
                  {"refused", status.problem.empty() ? 0 : 1},
                  {"camera_x", camera.position.x},
                  {"camera_y", camera.position.y},
                  {"camera_z", camera.position.z},
                  {"colour", static_cast<double>(session_->colour_by())},
                  {"mode", static_cast<double>(session_->rig().mode())}});
    return facts;
}

} // namespace carom::viewer
