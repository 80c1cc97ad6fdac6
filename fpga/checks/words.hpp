// The words of a bench's call. All are read before the first case is played, so that a wrong one at the end is not found after hours.
// Those that start with + are for the model.
#pragma once
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

class Words {
    std::vector<std::string> words;
    size_t read = 0;
    const char *known;                       // the legal calls

public:
    Words(int argc, char **argv, const char *known) : known(known) {
        for (int k = 1; k < argc; k++)
            if (argv[k][0] != '+')
                words.push_back(argv[k]);
        if (words.empty())
            refuse("a call without a word judges nothing");
    }

    [[noreturn]] void refuse(const std::string &why) const {
        std::printf("%s; known is: %s\n", why.c_str(), known);
        std::exit(2);
    }

    bool are_left() const { return read < words.size(); }

    std::string next(const char *what) {
        if (!are_left())
            refuse(std::string(what) + " is missing");
        return words[read++];
    }

    // A whole number; with the largest all seeds and counts stay within int.
    int number(const char *what, int least) {
        const std::string word = next(what);
        char *end = nullptr;
        errno = 0;
        const long value = std::strtol(word.c_str(), &end, 10);
        if (end == word.c_str() || *end || errno || value < least || value > 0x7fffffff)
            refuse(std::string(what) + " is " + word);
        return value;
    }
};
