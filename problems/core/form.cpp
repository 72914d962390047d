#include "problems/core/form.hpp"

namespace strongpoint {

#define FORM(name) FormEntry form_##name();
#include "problems/core/forms/forms.def"
#undef FORM

const std::vector<FormEntry>& forms() {
  static const std::vector<FormEntry> all{
#define FORM(name) form_##name(),
#include "problems/core/forms/forms.def"
#undef FORM
  };
  return all;
}

std::string canonical_form(std::string_view spec) {
  const Spec parsed = parse_spec(spec);
  const FormEntry& entry = find_entry(forms(), "form", parsed.name);
  Options options(entry.info, parsed);
  entry.factory.make<2>(options);  // refuses values that do not fit
  return options.canonical();
}

template <int Dim>
std::unique_ptr<Form<Dim>> make_form(std::string_view spec) {
  const Spec parsed = parse_spec(spec);
  const FormEntry& entry = find_entry(forms(), "form", parsed.name);
  Options options(entry.info, parsed);
  return entry.factory.make<Dim>(options);
}

template std::unique_ptr<Form<1>> make_form<1>(std::string_view);
template std::unique_ptr<Form<2>> make_form<2>(std::string_view);
template std::unique_ptr<Form<3>> make_form<3>(std::string_view);

}  // namespace strongpoint
