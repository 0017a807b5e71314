#include <filesystem>
#include <memory>
#include <string>

#include <dxflib/dl_dxf.h>

#include "softform/inflatables/pattern_files.hpp"
#include "softform/io/atomic_write.hpp"
#include "softform/io/text_file.hpp"

namespace softform {
namespace {

constexpr double mm = 1e3;
constexpr double gap_between_sheets = 20;  // [mm]

/// A DXF file in the order that dxflib wants its parts in.
class DxfFile {
 public:
  explicit DxfFile(const std::filesystem::path& path) : writer_(dxf_.out(path.c_str(), DL_Codes::AC1015)) {}

  bool is_open() const { return writer_ != nullptr; }

  void write_tables()
  {
    dxf_.writeHeader(*writer_);
    constexpr int millimetres = 4;
    writer_->dxfString(9, "$INSUNITS");
    writer_->dxfInt(70, millimetres);
    writer_->sectionEnd();
    writer_->sectionTables();
    dxf_.writeVPort(*writer_);
    writer_->tableLinetypes(3);
    for (const char* name : {"BYBLOCK", "BYLAYER", "CONTINUOUS"})
      dxf_.writeLinetype(*writer_, DL_LinetypeData(name, name, 0, 0, 0.0));
    writer_->tableEnd();
    writer_->tableLayers(1 + static_cast<int>(layer_styles().size()));
    dxf_.writeLayer(*writer_, DL_LayerData("0", 0), DL_Attributes("", 7, 25, "CONTINUOUS", 1));
    for (const LayerStyle& style : layer_styles())
      dxf_.writeLayer(*writer_, DL_LayerData(style.name, 0),
                      DL_Attributes("", style.color_index, hundredths(style), "CONTINUOUS", 1));
    writer_->tableEnd();
    writer_->tableStyle(1);
    dxf_.writeStyle(*writer_, DL_StyleData("Standard", 0, 0, 1, 0, 0, 2.5, "txt", ""));
    writer_->tableEnd();
    dxf_.writeView(*writer_);
    dxf_.writeUcs(*writer_);
    writer_->tableAppid(1);
    dxf_.writeAppid(*writer_, "ACAD");
    writer_->tableEnd();
    dxf_.writeDimStyle(*writer_, 1, 1, 1, 1, 1);
    dxf_.writeBlockRecord(*writer_);
    writer_->tableEnd();
    writer_->sectionEnd();
    writer_->sectionBlocks();
    for (const char* name : {"*Model_Space", "*Paper_Space", "*Paper_Space0"}) {
      dxf_.writeBlock(*writer_, DL_BlockData(name, 0, 0, 0, 0));
      dxf_.writeEndBlock(*writer_, name);
    }
    writer_->sectionEnd();
    writer_->sectionEntities();
  }

  void write(const PatternLine& line, double bottom)
  {
    dxf_.writePolyline(*writer_, DL_PolylineData(static_cast<int>(line.points.rows()), 0, 0, line.is_closed ? 1 : 0),
                       attributes(line.layer));
    for (Eigen::Index i = 0; i < line.points.rows(); ++i)
      dxf_.writeVertex(*writer_, DL_VertexData(mm * line.points(i, 0), bottom + mm * line.points(i, 1), 0));
    dxf_.writePolylineEnd(*writer_);
  }

  void write(const PatternText& text, double bottom)
  {
    constexpr int centered = 1, in_the_middle = 2;
    const double x = mm * text.center.x(), y = bottom + mm * text.center.y();
    dxf_.writeText(*writer_,
                   DL_TextData(x, y, 0, x, y, 0, mm * text.height, 1, 0, centered, in_the_middle, text.text, "Standard",
                               text.angle),
                   attributes(text.layer));
  }

  void finish()
  {
    writer_->sectionEnd();
    dxf_.writeObjects(*writer_);
    dxf_.writeObjectsEnd(*writer_);
    writer_->dxfEOF();
    writer_->close();
  }

 private:
  static int hundredths(const LayerStyle& style) { return static_cast<int>(1e5 * style.width + 0.5); }
  static DL_Attributes attributes(PatternLayer layer)
  {
    constexpr int by_layer_color = 256, by_layer_width = -1;
    return {style_of(layer).name, by_layer_color, by_layer_width, "BYLAYER", 1};
  }

  DL_Dxf dxf_;
  std::unique_ptr<DL_WriterA> writer_;
};

}  // namespace

void write_pattern_dxf(const std::filesystem::path& path, const std::vector<PatternPiece>& sheets)
{
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    DxfFile file(temporary);
    if (!file.is_open()) return false;
    file.write_tables();
    double bottom = 0;
    for (const PatternPiece& sheet : sheets) {
      for (const PatternLine& line : sheet.lines) file.write(line, bottom);
      for (const PatternText& text : sheet.texts) file.write(text, bottom);
      bottom -= mm * sheet.lines.front().points.col(1).maxCoeff() + gap_between_sheets;
    }
    file.finish();
    // dxflib does not say whether the disk took it all: the last line does.
    return read_text(temporary).find("EOF") != std::string::npos;
  });
}

}  // namespace softform
