#include "study/hdf5.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

namespace hybrid_sphere::study::hdf5 {
namespace {

constexpr unsigned level = 1;  // of deflate

Handle properties(hid_t of, const std::string& what) { return {H5Pcreate(of), H5Pclose, what}; }

/// Texts of one length, UTF-8, filled up with zeros.
Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "a type");
  require(H5Tset_size(type, std::max<std::size_t>(length, 1)), "a type");
  require(H5Tset_strpad(type, H5T_STR_NULLPAD), "a type");
  require(H5Tset_cset(type, H5T_CSET_UTF8), "a type");
  return type;
}

Handle space_of(const std::vector<std::uint64_t>& shape) {
  if (shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose, "a space"};
  const std::vector<hsize_t> sizes(shape.begin(), shape.end());
  return {H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose, "a space"};
}

/// One after another, each filled up to the length of the longest.
std::pair<std::size_t, std::string> in_a_row(const std::vector<std::string>& texts) {
  std::size_t length = 1;
  for (const std::string& text : texts) length = std::max(length, text.size());
  std::string row;
  for (std::string text : texts) {
    text.resize(length);
    row += text;
  }
  return {length, row};
}

void set(hid_t object, const std::string& name, hid_t type, const std::vector<std::uint64_t>& shape,
         const void* bytes) {
  const Handle space = space_of(shape);
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "the attribute " + name);
  require(H5Awrite(attribute, type, bytes), "the attribute " + name);
}

}  // namespace

void require(herr_t result, const std::string& what) {
  if (result < 0) throw FileError("HDF5 cannot write " + what);
}

Handle create_file(const std::string& file) {
  H5dont_atexit();  // after an error there the library would crash
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  return {H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, "\"" + file + "\""};
}

void close(Handle file, const std::string& name) {
  require(H5Fflush(file, H5F_SCOPE_GLOBAL), "\"" + name + "\"");
  const Handle closing = std::move(file);
}

void set_attribute(hid_t object, const std::string& name, const std::string& text) {
  const Handle type = text_type(text.size());
  const std::string bytes = text.empty() ? std::string(1, '\0') : text;
  set(object, name, type, {}, bytes.data());
}

void set_attribute(hid_t object, const std::string& name, double number) {
  set(object, name, H5T_NATIVE_DOUBLE, {}, &number);
}

void set_attribute(hid_t object, const std::string& name, std::uint64_t number) {
  set(object, name, H5T_NATIVE_UINT64, {}, &number);
}

Handle create_dataset(hid_t file, const std::string& name, hid_t type,
                      const std::vector<std::uint64_t>& shape, std::uint64_t chunk) {
  const Handle links = properties(H5P_LINK_CREATE, "a link");
  require(H5Pset_create_intermediate_group(links, 1), "a link");
  const Handle creation = properties(H5P_DATASET_CREATE, "a dataset");
  require(H5Pset_obj_track_times(creation, false), "a dataset");
  const std::uint64_t size =
      std::accumulate(shape.begin(), shape.end(), std::uint64_t{1}, std::multiplies<>());
  if (chunk > 0 && size > 0) {
    std::vector<hsize_t> sizes(shape.begin(), shape.end());
    sizes.front() = chunk;
    require(H5Pset_chunk(creation, static_cast<int>(sizes.size()), sizes.data()), name);
    require(H5Pset_shuffle(creation), name);
    require(H5Pset_deflate(creation, level), name);
  }
  const Handle space = space_of(shape);
  return {H5Dcreate2(file, name.c_str(), type, space, links, creation, H5P_DEFAULT), H5Dclose, name};
}

namespace {

void write_all(hid_t file, const std::string& name, hid_t type, const std::vector<std::uint64_t>& shape,
               const void* bytes, const std::string& unit) {
  const Handle dataset = create_dataset(file, name, type, shape, 0);
  if (!unit.empty()) set_attribute(dataset, "unit", unit);
  const bool is_empty = std::find(shape.begin(), shape.end(), std::uint64_t{0}) != shape.end();
  if (!is_empty) require(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes), name);
}

}  // namespace

void write(hid_t file, const std::string& name, const std::vector<double>& numbers,
           const std::vector<std::uint64_t>& shape, const std::string& unit) {
  write_all(file, name, H5T_NATIVE_DOUBLE, shape, numbers.data(), unit);
}

void write(hid_t file, const std::string& name, const std::vector<std::uint64_t>& numbers) {
  write_all(file, name, H5T_NATIVE_UINT64, {numbers.size()}, numbers.data(), "");
}

void write(hid_t file, const std::string& name, const std::vector<std::string>& texts) {
  const auto [length, row] = in_a_row(texts);
  const Handle type = text_type(length);
  write_all(file, name, type, {texts.size()}, row.data(), "");
}

}  // namespace hybrid_sphere::study::hdf5
