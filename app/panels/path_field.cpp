#include "app/panels/path_field.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include "app/panels/widgets.h"

namespace lightvane {
namespace {

int completeText(ImGuiInputTextCallbackData* data) {
  const auto& complete =
      *static_cast<const std::function<PathCompletion(const std::string&)>*>(data->UserData);
  const PathCompletion found = complete(std::string(data->Buf, static_cast<std::size_t>(data->BufTextLen)));
  data->DeleteChars(0, data->BufTextLen);
  data->InsertChars(0, found.common.c_str());
  return 0;
}

}  // namespace

bool pathField(const char* name, std::string& path, PathFocus focus,
               const std::function<PathCompletion(const std::string&)>& complete) {
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
  if (focus.takes) ImGui::SetKeyboardFocusHere();
  const ImGuiInputTextFlags completion = complete ? ImGuiInputTextFlags_CallbackCompletion : 0;
  const ImGuiInputTextFlags selection = focus.selectsAll ? ImGuiInputTextFlags_AutoSelectAll : 0;
  auto function = complete;
  const bool entered = ImGui::InputTextWithHint(fmt::format("##{}", name).c_str(), "Path", &path,
                                                ImGuiInputTextFlags_EnterReturnsTrue | completion | selection,
                                                complete ? completeText : nullptr, &function);
  Widgets::recordItem(name, path);
  return entered;
}

}  // namespace lightvane
