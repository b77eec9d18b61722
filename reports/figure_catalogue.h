#pragma once
// The figures, as their spec files in reports/figures describe themselves under "usermeta"."capstan".

#include <map>
#include <string>
#include <vector>

namespace capstan::reports {

struct Figure {
    std::string id;                            // the file's name without number and ending: 'error_matrix'
    std::string spec;                          // Vega-Lite, as in the file
    std::string page;                          // 'study', or an experiment's page: see experiment_page.h
    std::string section;                       // where on the page, see study_page.cpp
    std::string title;                         // a heading
    std::map<std::string, std::string> paper;  // regime -> the paper's figure it redraws
    std::string caption;                       // what to see, one or two sentences
    std::string per;  // drawn once per 'regime', 'recommendation', 'run', 'run and cable' or 'study' (page)
    std::vector<std::string> tables;     // of storage::report_queries(); all must have rows
    std::vector<std::string> knowledge;  // rows to draw by what the method knows; empty: all
    int panel_height_px = 0;
    int frame_height_px = 0;  // axes, legends and titles around the panels
    int row_frame_height_px = 0;
    std::string rows_by;  // a column of the first table: a row of panels per value; '': one row
};

const std::vector<Figure>& figures();  // in the order of the file names

}  // namespace capstan::reports
